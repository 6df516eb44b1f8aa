#include "dowel/io/step_writer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BinTools.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <catch2/catch.hpp>
#include <gp_Trsf.hxx>

#include "dowel/io/file.h"
#include "dowel/kernel/error.h"

namespace dowel {
namespace {

namespace fs = std::filesystem;

constexpr double kReadBack_mm = 1.0e-9;

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "dowel-step-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<std::byte> brep_of(const TopoDS_Shape& shape) {
  std::ostringstream stream;
  BinTools::Write(shape, stream);
  const std::string text = stream.str();
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

ExportPart box_part(const std::string& name) {
  return {name, brep_of(BRepPrimAPI_MakeBox(10.0, 20.0, 30.0).Shape()), std::nullopt};
}

ExportPart pin_part(const std::string& name) {
  return {name, brep_of(BRepPrimAPI_MakeCylinder(6.0, 50.0).Shape()), {{0.5, 0.25, 0.75}}};
}

struct ReadInstance {
  std::string name;
  std::string part;
  gp_Trsf placement;
  double volume_mm3 = 0.0;
};

struct ReadFile {
  std::string root;
  bool is_assembly = false;
  std::vector<ReadInstance> instances;
  std::size_t part_count = 0;
  std::map<std::string, std::array<double, 3>> colours;  ///< sRGB, by part
};

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  std::string text(static_cast<std::size_t>(name->Get().LengthOfCString()) + 1, '\0');
  char* start = text.data();
  name->Get().ToUTF8CString(start);
  text.resize(text.find('\0'));
  return text;
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

/// What OpenCascade's own reader finds: the independent end of the round trip.
ReadFile read_back(const fs::path& file) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
  STEPCAFControl_Reader reader;
  REQUIRE(reader.ReadFile(file.c_str()) == IFSelect_RetDone);
  REQUIRE(reader.Transfer(document));
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  TDF_LabelSequence roots;
  shapes->GetFreeShapes(roots);
  REQUIRE(roots.Length() == 1);
  ReadFile result;
  result.root = name_of(roots.Value(1));
  result.is_assembly = XCAFDoc_ShapeTool::IsAssembly(roots.Value(1));
  TDF_LabelSequence all;
  shapes->GetShapes(all);
  for (const TDF_Label& label : all) {
    if (XCAFDoc_ShapeTool::IsSimpleShape(label)) ++result.part_count;
  }
  TDF_LabelSequence components;
  XCAFDoc_ShapeTool::GetComponents(roots.Value(1), components);
  for (const TDF_Label& component : components) {
    TDF_Label part;
    REQUIRE(XCAFDoc_ShapeTool::GetReferredShape(component, part));
    result.instances.push_back({name_of(component), name_of(part),
                                XCAFDoc_ShapeTool::GetLocation(component).Transformation(),
                                volume_of(XCAFDoc_ShapeTool::GetShape(part))});
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(part);
    for (TopExp_Explorer faces(shape, TopAbs_SOLID); faces.More(); faces.Next()) {
      Quantity_Color colour;
      if (!colours->GetColor(faces.Current(), XCAFDoc_ColorSurf, colour)) continue;
      std::array<double, 3> rgb{};
      colour.Values(rgb[0], rgb[1], rgb[2], Quantity_TOC_sRGB);
      result.colours[name_of(part)] = rgb;
    }
  }
  XCAFApp_Application::GetApplication()->Close(document);
  return result;
}

double distance_mm(const gp_Trsf& found, const Pose& expected, const Eigen::Vector3d& point) {
  gp_Pnt moved(point.x(), point.y(), point.z());
  moved.Transform(found);
  return (Eigen::Vector3d(moved.X(), moved.Y(), moved.Z()) - expected * point).norm();
}

ErrorCode error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  FAIL("no error");
  return ErrorCode::NotFound;
}

}  // namespace

TEST_CASE("an assembly reads back with its names, parts and placements", "[property]") {
  const Folder folder;
  const unsigned seed = GENERATE(range(0U, 4U));
  CAPTURE(seed);
  std::mt19937 random(seed);
  // The last scene stands 10 m from the origin.
  const double reach_mm = seed == 3 ? 1.0e4 : 1.0e3;
  std::uniform_real_distribution<double> place(-reach_mm, reach_mm);
  std::normal_distribution<double> turn;
  std::vector<ExportInstance> instances;
  for (std::size_t i = 0; i < 20; ++i) {
    const Eigen::Quaterniond rotation =
        Eigen::Quaterniond(turn(random), turn(random), turn(random), turn(random)).normalized();
    const Eigen::Vector3d translation(place(random), place(random), place(random));
    instances.push_back({"I" + std::to_string(i), i % 2, Pose(rotation, translation)});
  }
  const std::vector<ExportPart> parts{box_part("H40-12/block"), pin_part("H40-12/pin")};
  write_step_assembly(folder / "a.step", "fixture", parts, instances);

  const ReadFile found = read_back(folder / "a.step");
  CHECK(found.root == "fixture");
  CHECK(found.is_assembly);
  CHECK(found.part_count == 2);
  REQUIRE(found.instances.size() == instances.size());
  double farthest_mm = 0.0;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    CAPTURE(i);
    CHECK(found.instances[i].name == instances[i].name);
    CHECK(found.instances[i].part == parts[instances[i].part].name);
    const double volume_mm3 = i % 2 == 0 ? 6000.0 : 1800.0 * std::numbers::pi;
    CHECK(found.instances[i].volume_mm3 == Approx(volume_mm3).epsilon(1e-12));
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(100.0, -50.0, 30.0)}) {
      CHECK(distance_mm(found.instances[i].placement, instances[i].X_WI, point) < kReadBack_mm);
    }
    farthest_mm = std::max(farthest_mm, instances[i].X_WI.translation().norm());
  }
  CHECK(farthest_mm > reach_mm / 2.0);  // the sample reaches as far as it says
}

TEST_CASE("the same assembly gives the same bytes, also after another one", "[determinism]") {
  const Folder folder;
  const std::vector<ExportPart> parts{box_part("block"), pin_part("pin")};
  const std::vector<ExportInstance> instances{
      {"A", 0, Pose{}}, {"B", 1, Pose::from_translation({1.0, 2.0, 3.0})}, {"C", 1, Pose{}}};
  write_step_assembly(folder / "first.step", "fixture", parts, instances);
  write_step_assembly(folder / "other.step", "other", parts, {{"X", 1, Pose{}}});
  write_step_assembly(folder / "second.step", "fixture", parts, instances);
  const std::string text = read_file(folder / "first.step");
  CHECK(text == read_file(folder / "second.step"));
  CHECK(text != read_file(folder / "other.step"));
  CHECK(text.find("AUTOMOTIVE_DESIGN") != std::string::npos);  // AP214
  CHECK(text.find(folder.path().string()) == std::string::npos);
  CHECK(text.find("FILE_NAME('fixture','1970-01-01T00:00:00',(''),(''),'dowel','dowel','');") !=
        std::string::npos);
}

TEST_CASE("colours read back, and parts without one have none") {
  const Folder folder;
  write_step_assembly(folder / "a.step", "fixture", {box_part("block"), pin_part("pin")},
                      {{"A", 0, Pose{}}, {"B", 1, Pose{}}});
  const ReadFile found = read_back(folder / "a.step");
  REQUIRE(found.colours.size() == 1);
  const std::array<double, 3>& colour = found.colours.at("pin");
  CHECK(colour[0] == Approx(0.5).margin(1e-6));
  CHECK(colour[1] == Approx(0.25).margin(1e-6));
  CHECK(colour[2] == Approx(0.75).margin(1e-6));
}

TEST_CASE("a single part is one product and no assembly") {
  const Folder folder;
  write_step_part(folder / "p.step", box_part("H40-12/block"));
  const ReadFile found = read_back(folder / "p.step");
  CHECK(found.root == "H40-12/block");
  CHECK_FALSE(found.is_assembly);
  CHECK(found.part_count == 1);
}

TEST_CASE("parts that no instance uses are left out") {
  const Folder folder;
  write_step_assembly(folder / "a.step", "fixture", {box_part("used"), pin_part("unused")},
                      {{"A", 0, Pose{}}});
  CHECK(read_file(folder / "a.step").find("unused") == std::string::npos);
  CHECK(read_back(folder / "a.step").part_count == 1);
}

TEST_CASE("names of any language and length survive in a file of plain ASCII") {
  const std::string name =
      GENERATE(std::string("Spann\xC3\xA4rm it's \\ odd"),
               std::string("part \xE6\xBC\xA2\xE5\xAD\x97 \xF0\x9F\x94\xA9"),
               std::string("a long name without any blank") + std::string(200, 'x'),
               std::string("1.50000E+00, -0.0 are no numbers here"), std::string(150, '\''));
  const Folder folder;
  write_step_assembly(folder / "a.step", name, {box_part(name)}, {{name, 0, Pose{}}});
  const std::string text = read_file(folder / "a.step");
  CHECK(std::all_of(text.begin(), text.end(), [](char c) { return c > 0 && c < 127; }));
  const ReadFile found = read_back(folder / "a.step");
  CHECK(found.root == name);
  REQUIRE(found.instances.size() == 1);
  CHECK(found.instances[0].name == name);
  CHECK(found.instances[0].part == name);
}

TEST_CASE("a name that is not UTF-8 is written with replacement characters") {
  const Folder folder;
  write_step_part(folder / "p.step", box_part("a\xFFz"));
  const std::string text = read_file(folder / "p.step");
  CHECK(std::all_of(text.begin(), text.end(), [](char c) { return c > 0 && c < 127; }));
}

TEST_CASE("numbers of all sizes keep their exponents") {
  const Folder folder;
  const double x = GENERATE(1.23456789012345e-3, 0.0999999999999999, 99.9999999999999,
                            123.456789012345, 98765.4321098765);
  write_step_part(
      folder / "p.step",
      {"p", brep_of(BRepPrimAPI_MakeBox(gp_Pnt(-x, -x, -x), gp_Pnt(x, 1.0, 2.0)).Shape()),
       std::nullopt});
  write_step_assembly(folder / "a.step", "a", {box_part("p")},
                      {{"i", 0, Pose::from_translation({x, -x, 2.0 * x})}});
  const gp_XYZ t = read_back(folder / "a.step").instances.at(0).placement.TranslationPart();
  CHECK(std::abs(t.X() - x) <= 1e-14 * std::max(1.0, x) * 10.0);
  CHECK(std::abs(t.Z() - 2.0 * x) <= 1e-14 * std::max(1.0, x) * 20.0);
}

TEST_CASE("a damaged boundary representation is an error and leaves the old file", "[fault]") {
  const Folder folder;
  const fs::path file = folder / "p.step";
  write_file(file, "old");
  const std::vector<std::byte> sound = box_part("p").brep;
  ExportPart part{"gripper", {}, std::nullopt};
  SECTION("empty") {}
  SECTION("text") {
    part.brep.assign(1000, std::byte{'x'});
  }
  SECTION("cut") {
    part.brep.assign(sound.begin(), sound.begin() + 1000);
  }
  CHECK(error_of([&] { write_step_part(file, part); }) == ErrorCode::FileMalformed);
  CHECK(error_of([&] {
          write_step_assembly(file, "a", {part}, {{"i", 0, Pose{}}});
        }) == ErrorCode::FileMalformed);
  CHECK(read_file(file) == "old");
  CHECK_THROWS_WITH(write_step_part(file, part), Catch::Contains("gripper"));
}

TEST_CASE("random damage never ends the program", "[property][fault]") {
  const Folder folder;
  const std::vector<std::byte> sound = pin_part("p").brep;
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 40; ++i) {
    ExportPart part{"p", sound, std::nullopt};
    for (int k = 0; k < 10; ++k) {
      part.brep[random() % part.brep.size()] = static_cast<std::byte>(random() & 0xFFU);
    }
    try {
      write_step_part(folder / "p.step", part);
    } catch (const Error& error) {
      CHECK(error.code() == ErrorCode::FileMalformed);
      ++refused;
    }
  }
  CHECK(refused > 20);  // most of it does damage
}

TEST_CASE("what cannot be written is an error", "[fault]") {
  const Folder folder;
  const std::vector<ExportPart> parts{box_part("p")};
  CHECK(error_of([&] { write_step_assembly(folder / "a.step", "a", parts, {}); }) ==
        ErrorCode::InvalidInput);
  CHECK(error_of([&] { write_step_part(folder / "no/such/folder.step", parts[0]); }) ==
        ErrorCode::FileUnwritable);
  CHECK(fs::is_empty(folder.path()));
  CHECK_THROWS_AS(write_step_assembly(folder / "a.step", "a", parts, {{"i", 1, Pose{}}}),
                  std::logic_error);
}

}  // namespace dowel
