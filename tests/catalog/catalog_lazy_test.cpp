// What is read of a catalogue, counted by the kernel.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/catalog/catalog.h"
#include "dowel/catalog/search.h"
#include "program.h"
#include "records.h"

using namespace dowel;

namespace {

/// Bytes that this process has read so far.
std::uintmax_t bytes_read() {
  std::ifstream file("/proc/self/io");
  std::string key;
  std::uintmax_t value = 0;
  while (file >> key >> value) {
    if (key == "rchar:") return value;
  }
  return 0;
}

template <class Body>
std::uintmax_t bytes_read_by(const Body& body) {
  const std::uintmax_t before = bytes_read();
  body();
  return bytes_read() - before;
}

}  // namespace

TEST_CASE("Opening a catalogue reads a few pages, and listing it no content") {
  constexpr std::size_t kElements = 400;
  constexpr std::size_t kContent_bytes = 40'000;
  const testing::TemporaryFolder folder;
  const auto file = folder / "c.db";
  {
    Catalog catalog(file, Catalog::Access::ReadWrite);
    std::vector<ElementRecord> records;
    for (std::size_t i = 0; i < kElements; ++i) {
      records.push_back(testing::block_record("block-" + std::to_string(i)));
      records.back().brep.assign(kContent_bytes, static_cast<std::byte>(i % 251));
      records.back().brep.front() = static_cast<std::byte>(i / 251);
    }
    catalog.put(testing::block_source("blocks.step"), records);
  }
  const std::uintmax_t size = std::filesystem::file_size(file);
  REQUIRE(size > kElements * kContent_bytes);
  CHECK(bytes_read_by([&] { Catalog(file, Catalog::Access::ReadOnly); }) < 100'000);
  const Catalog catalog(file, Catalog::Access::ReadOnly);
  const std::uintmax_t listed =
      bytes_read_by([&] { CHECK(search(catalog, {}).size() == kElements); });
  CHECK(listed > 1000);  // the count counts
  CHECK(listed < size / 4);
  CHECK(bytes_read_by([&] { catalog.brep("block-7"); }) >= kContent_bytes);
}
