#include "dowel/io/file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dowel/kernel/error.h"

namespace dowel {
namespace {

[[noreturn]] void fail_to_write(const std::filesystem::path& file, int error_number) {
  throw Error(ErrorCode::FileUnwritable,
              file.string() + ": cannot be written: " + std::strerror(error_number));
}

/// Writes all of `content` and flushes it to disk. Returns 0 or an errno.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(descriptor) == 0 ? 0 : errno;
}

}  // namespace

std::string read_file(const std::filesystem::path& file, std::size_t max_bytes) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (!std::filesystem::exists(status)) {
    throw Error(ErrorCode::FileUnreadable, file.string() + ": no such file");
  }
  if (std::filesystem::is_directory(status)) {
    throw Error(ErrorCode::FileUnreadable, file.string() + ": is a folder, expected a file");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(ErrorCode::FileUnreadable,
                file.string() + ": cannot be read: " + std::strerror(errno));
  }
  std::string content;
  std::string chunk(1U << 16U, '\0');
  while (stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) ||
         stream.gcount() > 0) {
    content.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
    if (content.size() > max_bytes) {
      throw Error(ErrorCode::FileUnreadable, file.string() + ": larger than the " +
                                                 std::to_string(max_bytes) + " bytes allowed");
    }
  }
  if (stream.bad()) throw Error(ErrorCode::FileUnreadable, file.string() + ": read error");
  return content;
}

void write_file(const std::filesystem::path& file, std::string_view content) {
  std::string temporary = file.string() + ".XXXXXX";
  const int descriptor = ::mkstemp(temporary.data());
  if (descriptor < 0) fail_to_write(file, errno);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  int error_number = ::fchmod(descriptor, 0666U & ~mask) == 0 ? 0 : errno;
  if (error_number == 0) error_number = write_all(descriptor, content);
  if (::close(descriptor) != 0 && error_number == 0) error_number = errno;
  if (error_number == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) error_number = errno;
  if (error_number != 0) {
    ::unlink(temporary.c_str());
    fail_to_write(file, error_number);
  }
}

void write_file(const std::filesystem::path& file, std::span<const std::byte> content) {
  write_file(file, std::string_view(reinterpret_cast<const char*>(content.data()), content.size()));
}

}  // namespace dowel
