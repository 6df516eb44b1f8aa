#include "json.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "dowel/kernel/error.h"

namespace dowel::tools {

Json to_json(const Eigen::Vector3d& vector) {
  return Json::array({vector.x(), vector.y(), vector.z()});
}

std::string to_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void print_line(std::string_view text) {
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() &&
                          std::fputc('\n', stdout) != EOF && std::fflush(stdout) == 0;
  if (!is_written) {
    throw Error(ErrorCode::FileUnwritable,
                std::string("standard output: cannot be written: ") + std::strerror(errno));
  }
}

}  // namespace dowel::tools
