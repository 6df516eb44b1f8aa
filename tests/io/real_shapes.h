#pragma once

#include <filesystem>
#include <vector>

#include <STEPControl_Reader.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp_Explorer.hxx>

#include "library/builders.h"
#include "oracle_shapes.h"

/// Exact shapes that were not made for a test.
namespace dowel::testing {

/// Elements of the library as they are; none has upright holes that pins are put into.
inline std::vector<NamedShape> library_shapes(const std::vector<library::Part>& parts) {
  std::vector<NamedShape> result;
  result.reserve(parts.size());
  for (const library::Part& part : parts) result.push_back({part.name, part.solid, {}});
  return result;
}

/// Solids of real STEP files in `folder`; none where it is not there.
inline std::vector<NamedShape> real_shapes(const std::filesystem::path& folder) {
  std::vector<NamedShape> result;
  for (const char* file :
       {"fcl2015/608ZZ_Ball_Bearing.step", "fcl2015/DIN463_M20TabWasher.step",
        "fcl2015/DIN7349_M5FlatWasher.step", "fcl2015/DN15_Stamped_Flange.step",
        "fcl2015/Hex-Standoff-M3-12mm-Male-Female.step",
        "fcl2015/ISO4017_Hex_Head_Cap_Screw_M6x25.step", "fcl2015/ISO4032_Hex_Nut_M10.step",
        "fcl2015/ISO4762_Hex_Socket_Head_Cap_Screw_M6x12.step",
        "fcl2015/ISO10642_Hex_Socket_Countersunk_Head_Screw_M6x12.step",
        "fcl2015/ISO7092DIN433_M24FlatWasher.step", "fcl2015/LM12uu.step",
        "mfcad/1-2-8-12-14-23.step", "o2ac/01-BASE.step", "o2ac/02-PANEL.step",
        "stepnode/simple_block_workpiece.stp"}) {
    if (!std::filesystem::exists(folder / file)) continue;
    STEPControl_Reader reader;
    reader.ReadFile((folder / file).c_str());
    reader.TransferRoots();
    for (TopExp_Explorer it(reader.OneShape(), TopAbs_SOLID); it.More(); it.Next()) {
      result.push_back({file, it.Current(), {}});
    }
  }
  return result;
}

}  // namespace dowel::testing
