#include "dowel/assembly/names.h"

#include <set>

#include <catch2/catch.hpp>

#include "dowel/assembly/suggest.h"

using dowel::did_you_mean;
using dowel::free_name;
using dowel::instance_name_defect;
using dowel::role_of;
using dowel::similar_words;

TEST_CASE("the role of an element is the first word of its name without digits") {
  CHECK(role_of("H40-12/plate-10x8") == "PLATE");
  CHECK(role_of("H40-12/screw-M12x55") == "SCREW");
  CHECK(role_of("rest-pad-20") == "REST");
  CHECK(role_of("M12 nut") == "NUT");
  CHECK(role_of("4711") == "PART");
  CHECK(role_of("") == "PART");
  CHECK(role_of("folder/") == "PART");
}

TEST_CASE("generated names take the first number that is free") {
  const std::set<std::string> taken{"RISER1", "RISER3"};
  const auto is_taken = [&](const std::string& name) { return taken.contains(name); };
  CHECK(free_name("x/riser-80", is_taken) == "RISER2");
  CHECK(free_name("x/plate", is_taken) == "PLATE1");
}

TEST_CASE("a name that would not read back from a script is refused") {
  for (const char* good : {"R1", "base-plate_2", "Größe", "a,b", "1"}) {
    CAPTURE(good);
    CHECK(!instance_name_defect(good));
  }
  const std::string too_long(65, 'x');
  for (const std::string bad :
       {"", "a.b", "a b", "a\tb", "#1", "it's", "say\"", "bad\xff", "cut\xc3", "\xed\xa0\x80",
        "\xc0\xaf", "\xf4\x90\x80\x80", too_long.c_str()}) {
    CAPTURE(bad);
    CHECK(instance_name_defect(bad));
  }
}

TEST_CASE("suggestions are names a few letters off, nearest first") {
  const std::vector<std::string> names{"place", "insert", "move", "remove", "mode"};
  CHECK(similar_words("plcae", names) == std::vector<std::string>{"place"});
  CHECK(similar_words("mvoe", names) == std::vector<std::string>{"move"});
  CHECK(similar_words("INSERT", names) == std::vector<std::string>{"insert"});
  CHECK(similar_words("ins", names) == std::vector<std::string>{"insert"});
  CHECK(similar_words("xyzzy", names).empty());
  CHECK(similar_words("", names).empty());
  CHECK(did_you_mean({}).empty());
  CHECK(did_you_mean({"A", "B", "C"}) == "; did you mean A, B or C?");
}
