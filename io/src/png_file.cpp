#include "png_file.h"

#include <iterator>
#include <string>

#include <png.h>

#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"

namespace dowel {

std::vector<std::byte> encode_png(std::span<const std::uint8_t> rgb, std::uint32_t width_px,
                                  std::uint32_t height_px) {
  DOWEL_EXPECTS(!rgb.empty() && rgb.size() == std::size_t{3} * width_px * height_px);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width_px;
  image.height = height_px;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  std::vector<std::byte> bytes;
  bool done = png_image_write_get_memory_size(image, size, 0, rgb.data(), 0, nullptr) != 0;
  if (done) {
    bytes.resize(size);
    done = png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) != 0;
  }
  if (!done) {
    throw Error(ErrorCode::InvalidInput,
                std::string("the picture cannot be written as PNG: ") + std::begin(image.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace dowel
