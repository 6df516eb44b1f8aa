#include "part_names.h"

#include <catch2/catch.hpp>

namespace dowel {
namespace {

TEST_CASE("text becomes valid UTF-8 on one line") {
  CHECK(clean_text("  base\t plate\r\n") == "base plate");
  CHECK(clean_text("Größe") == "Größe");
  CHECK(clean_text("Gr\xF6\xDF"
                   "e") == "Größe");
  CHECK(clean_text("\x80\x93") == "€“");
  CHECK(clean_text("a\xC2\x85z") == "a z");
  CHECK(clean_text(std::string("a\0b", 3)) == "a b");
  // A surrogate and an overlong form are not UTF-8: each byte is taken for itself.
  CHECK(is_utf8(clean_text("\xED\xA0\x80")));
  CHECK(is_utf8(clean_text("\xC0\xAF")));
  CHECK(is_utf8(clean_text("\xF0\x9F\x94")));
  CHECK(clean_text("").empty());
}

TEST_CASE("long names are cut at a character") {
  std::string name;
  for (int i = 0; i < 150; ++i) name += "ä";
  CHECK(clean_text(name).size() == kMaxNameBytes);
  CHECK(is_utf8(clean_text("x" + name)));
  CHECK(clean_text("x" + name).size() == kMaxNameBytes - 1);
}

TEST_CASE("escapes of STEP strings are decoded") {
  CHECK(decode_step_text("plain") == "plain");
  CHECK(decode_step_text("\\X2\\00C4\\X0\\b") == "Äb");
  CHECK(decode_step_text("\\X2\\D83DDD29\\X0\\") == "\xF0\x9F\x94\xA9");
  CHECK(decode_step_text("\\X4\\0001F529\\X0\\") == "\xF0\x9F\x94\xA9");
  CHECK(decode_step_text("\\X\\C4") == "Ä");
  CHECK(decode_step_text("\\S\\D") == "Ä");
  CHECK(decode_step_text("a\\\\b") == "a\\b");
}

TEST_CASE("malformed escapes stay as they are") {
  for (const char* text : {"\\X2\\00C4", "\\X2\\00C\\X0\\", "\\X2\\zzzz\\X0\\", "\\X\\G1", "\\X\\",
                           "\\S\\", "\\", "\\Q", "\\X4\\00C4\\X0\\"}) {
    CAPTURE(text);
    CHECK(decode_step_text(text) == text);
  }
  CHECK(is_utf8(decode_step_text("\\X2\\D83D\\X0\\")));
  CHECK(is_utf8(decode_step_text("\\X4\\FFFFFFFF\\X0\\")));
}

TEST_CASE("names that translators make up are not usable") {
  for (const char* name :
       {"", "SOLID", "Solid_2", "1234", "Open CASCADE STEP translator 7.6 1.2", "Part__Feature001",
        "unnamed", "ASSEMBLY", "Body (3)", "COMPOUND", "---"}) {
    CAPTURE(name);
    CHECK_FALSE(is_usable_name(name));
  }
  for (const char* name : {"M8x30", "base plate", "Solid base", "Partner", "治具", "V2 block"}) {
    CAPTURE(name);
    CHECK(is_usable_name(name));
  }
}

TEST_CASE("each part of a file has a name of its own") {
  CHECK(part_names({"SOLID", "bolt", "", "bolt", "vise", "vise-2"}, "vise") ==
        std::vector<std::string>{"vise", "bolt", "vise-2", "bolt-2", "vise-3", "vise-2-2"});
}

}  // namespace
}  // namespace dowel
