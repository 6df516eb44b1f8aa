#include "write_library.h"

#include <sstream>
#include <system_error>

#include <BinTools.hxx>

#include "dowel/io/file.h"
#include "dowel/io/step_writer.h"
#include "dowel/kernel/error.h"
#include "manifest.h"

namespace dowel::library {

std::string file_name(const Part& part) {
  return part.name + ".step";
}

std::vector<std::byte> to_brep(const TopoDS_Shape& shape) {
  std::ostringstream stream;
  BinTools::Write(shape, stream, Standard_False, Standard_False, BinTools_FormatVersion_CURRENT);
  const std::string bytes = std::move(stream).str();
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  return {first, first + bytes.size()};
}

void write_library(const std::filesystem::path& folder, const std::vector<Part>& parts) {
  for (const Part& part : parts) {
    const std::filesystem::path file = folder / file_name(part);
    std::error_code failure;
    std::filesystem::create_directories(file.parent_path(), failure);
    if (failure) {
      throw Error(ErrorCode::FileUnwritable,
                  file.parent_path().string() + ": folder cannot be made: " + failure.message());
    }
    write_step_part(file, {part.name, to_brep(part.solid), part.colour});
  }
  write_file(folder / "library.json", manifest_json(parts));
}

}  // namespace dowel::library
