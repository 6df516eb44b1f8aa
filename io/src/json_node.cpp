#include "json_node.h"

#include "dowel/io/file.h"

namespace dowel {

nlohmann::json parse_json_file(const std::filesystem::path& file) {
  using Json = nlohmann::json;
  const std::string text = read_file(file);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    // The library's message reads "[json.exception...] parse error at line 3, column 7: …".
    const std::string_view message = error.what();
    const std::size_t start = message.find("] ");
    throw Error(ErrorCode::FileMalformed,
                file.string() + ": not JSON: " +
                    std::string(start == message.npos ? message : message.substr(start + 2)));
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::FileMalformed, file.string() + ": " + error.what());
  }
}

}  // namespace dowel
