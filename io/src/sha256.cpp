#include "sha256.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include <openssl/evp.h>

#include "dowel/kernel/error.h"

namespace dowel {
namespace {

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const noexcept { EVP_MD_CTX_free(context); }
};

}  // namespace

std::string sha256_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(ErrorCode::FileUnreadable,
                file.string() + ": cannot be read: " + std::strerror(errno));
  }
  const std::unique_ptr<EVP_MD_CTX, FreeContext> context(EVP_MD_CTX_new());
  bool is_good = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  std::vector<char> chunk(1U << 16U);
  while (is_good && (stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) ||
                     stream.gcount() > 0)) {
    is_good = EVP_DigestUpdate(context.get(), chunk.data(),
                               static_cast<std::size_t>(stream.gcount())) == 1;
  }
  if (stream.bad()) throw Error(ErrorCode::FileUnreadable, file.string() + ": read error");
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  is_good = is_good && EVP_DigestFinal_ex(context.get(), digest.data(), &size) == 1;
  if (!is_good) throw std::bad_alloc();  // what else can stop a digest

  constexpr const char* kHexDigits = "0123456789abcdef";
  std::string hex;
  for (unsigned i = 0; i < size; ++i) {
    hex += kHexDigits[digest[i] >> 4U];
    hex += kHexDigits[digest[i] & 15U];
  }
  return hex;
}

}  // namespace dowel
