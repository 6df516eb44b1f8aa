// How long a large catalogue takes; hidden, for it says something on a quiet machine only. Run by
// tag: dowel_catalog_tests "[benchmark]"

#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/catalog/search.h"
#include "program.h"
#include "records.h"

using namespace dowel;

namespace {

template <class Body>
double time_ms(const Body& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  return taken.count();
}

}  // namespace

TEST_CASE("time to open, list and search a catalogue of 10,000 elements", "[.benchmark]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "c.db";
  const double put_ms = time_ms([&] {
    Catalog catalog(file, Catalog::Access::ReadWrite);
    for (int source = 0; source < 100; ++source) {
      std::vector<ElementRecord> records;
      for (int i = 0; i < 100; ++i) {
        const int number = 100 * source + i;
        records.push_back(
            testing::block_record("H40/block-" + std::to_string(number), 20.0 + 0.01 * number));
      }
      catalog.put(testing::block_source("blocks" + std::to_string(source) + ".step"), records);
    }
  });
  std::size_t names = 0;
  std::size_t listed = 0;
  std::size_t found = 0;
  const double open_ms = time_ms([&] { Catalog(file, Catalog::Access::ReadOnly); });
  const Catalog catalog(file, Catalog::Access::ReadOnly);
  const double names_ms = time_ms([&] { names = catalog.names().size(); });
  const double one_ms = time_ms([&] { catalog.find("H40/block-4711"); });
  const double list_ms = time_ms([&] { listed = search(catalog, {}).size(); });
  const std::vector<std::string> terms{"block", "length>=100"};
  const double search_ms = time_ms([&] { found = search(catalog, parse_query(terms)).size(); });
  std::printf(
      "put %.0f ms, open %.2f ms, names %.1f ms, one element %.2f ms, list %.0f ms, search %.0f "
      "ms; %ju bytes\n",
      put_ms, open_ms, names_ms, one_ms, list_ms, search_ms,
      static_cast<std::uintmax_t>(std::filesystem::file_size(file)));
  CHECK(names == 10000);
  CHECK(listed == 10000);
  CHECK(found == 2000);
}
