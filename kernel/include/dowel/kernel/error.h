#pragma once

#include <stdexcept>
#include <string>

namespace dowel {

/// What went wrong outside the program. The console tool answers each with exit code 3.
enum class ErrorCode {
  FileUnreadable,  ///< missing, a folder, no permission
  FileUnwritable,  ///< no permission, no room
  FileMalformed,   ///< not what its name or its place promised, truncated, damaged
  SchemaMismatch,  ///< a database of another program or of a newer version
  NotFound,        ///< a name that nothing carries
  InvalidInput     ///< a command, key or number that makes no sense here
};

/// A failure of the outside world: a file, a database, a script. `what()` is one sentence that
/// names the place and says what was expected. Geometric outcomes such as "no contact" are return
/// values; caller bugs are DOWEL_EXPECTS.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}

  ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace dowel
