#include "dowel/catalog/search.h"

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "program.h"
#include "records.h"

namespace {

using dowel::closest_names;
using dowel::Element;
using dowel::Error;
using dowel::matches;
using dowel::parse_query;

using Words = std::vector<std::string>;

bool finds(const Element& element, const Words& terms) {
  return matches(element, parse_query(terms));
}

}  // namespace

TEST_CASE("Words are looked for in name, family, shape and features, whatever their case") {
  Element block = dowel::testing::block_record("Riser-80").element;
  block.family = "H40-12";
  CHECK(finds(block, {}));
  CHECK(finds(block, {"RISER"}));
  CHECK(finds(block, {"h40"}));
  CHECK(finds(block, {"block-cyl"}));
  CHECK(finds(block, {"cb1"}));
  CHECK(finds(block, {"shaft"}));
  CHECK(finds(block, {"riser", "h40"}));
  CHECK(finds(block, {"riser h40"}));
  CHECK_FALSE(finds(block, {"riser", "clamp"}));
}

TEST_CASE("Numbers are compared with the box, the holes and the shafts") {
  const Element block = dowel::testing::block_record("block").element;  // 80 x 40 x 20
  CHECK(finds(block, {"length>=80"}));
  CHECK(finds(block, {"length<=80"}));
  CHECK(finds(block, {"l=80", "W=40", "height=20"}));
  CHECK_FALSE(finds(block, {"length>80"}));
  CHECK_FALSE(finds(block, {"length<80"}));
  CHECK(finds(block, {"height=15..25"}));
  CHECK_FALSE(finds(block, {"height=21..25"}));
  CHECK(finds(block, {"hole=12"}));
  CHECK_FALSE(finds(block, {"hole=11.99"}));
  CHECK(finds(block, {"shaft==11.99"}));
  CHECK_FALSE(finds(block, {"shaft=12"}));
  CHECK(finds(block, {"d<12"}));
  CHECK(finds(block, {"d>11.99"}));
  CHECK_FALSE(finds(block, {"d>12"}));
  CHECK(finds(block, {"depth=20"}));
  CHECK(finds(block, {"holes=2"}));
  CHECK(finds(block, {"volume>63999", "volume<64001"}));
  CHECK(finds(block, {"block", "hole=12", "holes>1"}));
}

TEST_CASE("An element without holes has no hole of any size") {
  Element block = dowel::testing::block_record("block").element;
  block.features.clear();
  CHECK_FALSE(finds(block, {"hole>=0"}));
  CHECK_FALSE(finds(block, {"hole<1000"}));
  CHECK(finds(block, {"holes=0"}));
}

TEST_CASE("Rounding in a box does not lose an element") {
  Element block = dowel::testing::block_record("block").element;
  block.obb.half_extents_mm.z() = 10.0 - 1e-13;
  CHECK(finds(block, {"height>=20"}));
}

TEST_CASE("Blanks around a comparison do not matter") {
  for (const Words& terms : {Words{"height >= 80", "x"},
                             {"height", ">=", "80", "x"},
                             {"height>=", "80 x"},
                             {" height  >=80  x "}}) {
    const dowel::SearchQuery query = parse_query(terms);
    CAPTURE(terms);
    REQUIRE(query.conditions.size() == 1);
    CHECK(query.conditions[0].low == Approx(80.0).margin(0.001));
    CHECK(query.words == Words{"x"});
  }
}

TEST_CASE("A term that makes no sense is an error that names it", "[fault]") {
  for (const char* term :
       {"height>=", "height>=abc", ">=80", "colour=3", "height=>80", "h=1..", "h=..2", "h=1e999",
        "h=nan", "h<>3", "=", "h=1=2", "h=12kg", "mass=2mm"}) {
    CAPTURE(term);
    CHECK_THROWS_AS(parse_query(Words{term}), Error);
    CHECK_THROWS_WITH(parse_query(Words{term}), Catch::Contains(term));
  }
}

TEST_CASE("What a maker states is found by words and by what it is") {
  Element riser = dowel::testing::block_record("riser").element;
  riser.role = "riser";
  riser.description = "carries one node";
  riser.features[1].fit = "H7";  // A1, with a thread M12
  CHECK(finds(riser, {"riser hole M12"}));
  CHECK(finds(riser, {"hole=m12"}));
  CHECK(finds(riser, {"thread=M12"}));
  CHECK(finds(riser, {"M12"}));
  CHECK_FALSE(finds(riser, {"shaft M12"}));
  CHECK_FALSE(finds(riser, {"hole M16"}));
  CHECK_FALSE(finds(riser, {"thread=M1"}));
  CHECK_FALSE(finds(riser, {"thread=M12x1.5"}));
  CHECK(finds(riser, {"hole", "steel"}));  // no thread follows: two words
  CHECK(finds(riser, {"fit=H7"}));
  CHECK(finds(riser, {"fit=g6"}));
  CHECK_FALSE(finds(riser, {"fit=h7"}));
  CHECK(finds(riser, {"role=Riser", "material=c45"}));
  CHECK_FALSE(finds(riser, {"role=rise"}));
  CHECK(finds(riser, {"node"}));
  CHECK(finds(riser, {"6321"}));
  CHECK(finds(riser, {"mass>0.502", "mass<0.503"}));  // 64 cm3 of steel: 0.5024 kg
  riser.density_kg_per_m3 = 0.0;
  CHECK_FALSE(finds(riser, {"mass>=0"}));
}

TEST_CASE("Errors name the place in the query", "[fault]") {
  CHECK_THROWS_WITH(parse_query(Words{"riser", "height>=x"}),
                    "search query, character 7, \"height>=x\": expected a number instead of \"x\"");
  CHECK_THROWS_WITH(parse_query(Words{"riser thread=12"}),
                    Catch::Contains("character 7") && Catch::Contains("M12x1.5"));
  CHECK_THROWS_WITH(parse_query(Words{"role>3"}), Catch::Contains("expected = after role"));
  CHECK_THROWS_WITH(parse_query(Words{"role="}), Catch::Contains("a word after ="));
}

TEST_CASE("A number may carry the unit that it has anyway") {
  const Element block = dowel::testing::block_record("block").element;
  CHECK(finds(block, {"height=40mm"}) == finds(block, {"height=40"}));
  CHECK(finds(block, {"height=1mm..400mm"}));
  CHECK(finds(block, {"mass<2kg"}));
  CHECK(finds(block, {"volume>1mm3"}));
  CHECK_THROWS_WITH(parse_query(Words{"holes>=2mm"}), Catch::Contains("a number"));
}

TEST_CASE("A quantity that is misspelt is met with the one that was meant", "[fault]") {
  CHECK_THROWS_WITH(parse_query(Words{"hieght>=80"}), Catch::Contains("did you mean height?"));
  CHECK_THROWS_WITH(parse_query(Words{"colour=3"}), !Catch::Contains("did you mean"));
}

TEST_CASE("A search that finds nothing says which term is to blame and what may have been meant") {
  const dowel::testing::TemporaryFolder folder;
  dowel::Catalog catalog(folder / "c.db", dowel::Catalog::Access::ReadWrite);
  for (const char* name : {"riser", "clamp"}) {
    dowel::ElementRecord record = dowel::testing::block_record(name);
    record.element.role = name;
    catalog.put(dowel::testing::block_source(name), std::vector{record});
  }
  const auto why = [&catalog](const Words& terms) {
    return dowel::explain_no_match(catalog, parse_query(terms));
  };
  CHECK(why({"rsier"}) == Words{"no element matches \"rsier\"; did you mean \"riser\"?"});
  CHECK(why({"role=clmap", "riser"}) ==
        Words{"no element matches \"role=clmap\"; did you mean \"clamp\"?"});
  CHECK(why({"hole M13"}) == Words{"no element matches \"hole M13\"; did you mean \"M12\"?"});
  CHECK(why({"length>=9000"}) == Words{"no element matches \"length>=9000\""});
  CHECK(why({"height", "80"}).front() ==
        "no element matches \"height\"; a size is compared, as in height>=1");
  CHECK(why({"role=clamp", "role=riser"}) ==
        Words{"each term matches some element, but none matches all of them"});
}

TEST_CASE("A search gives those that match, names before families before features") {
  const dowel::testing::TemporaryFolder folder;
  dowel::Catalog catalog(folder / "c.db", dowel::Catalog::Access::ReadWrite);
  const auto put = [&catalog](const std::string& name, const std::string& family) {
    dowel::ElementRecord record = dowel::testing::block_record(name);
    record.element.family = family;
    catalog.put(dowel::testing::block_source(name), std::vector{record});
  };
  put("zz", "pin family");
  put("b-pin", "");
  put("pin-9", "");
  put("aa", "");  // has a feature pin1
  put("pin", "");
  Words names;
  for (const Element& element : search(catalog, parse_query(Words{"pin"}))) {
    names.push_back(element.name);
  }
  CHECK(names == Words{"pin", "pin-9", "b-pin", "zz", "aa"});
}

TEST_CASE("The name that was meant is the first guess") {
  const Words names{
      "H40-12/riser-80x80x40", "H40-12/riser-80x80x80", "H40-12/stop", "pin-12", "plate", "Vise"};
  CHECK(closest_names("plaet", names) == Words{"plate"});
  CHECK(closest_names("PLATE", names) == Words{"plate"});
  CHECK(closest_names("vice", names) == Words{"Vise"});
  CHECK(closest_names("riser", names).size() == 2);
  CHECK(closest_names("riser", names, 1).size() == 1);
  CHECK(closest_names("riser-80x80x80", names).front() == "H40-12/riser-80x80x80");
  CHECK(closest_names("h40-12/stopp", names) == Words{"H40-12/stop"});
  CHECK(closest_names("turbine", names).empty());
  CHECK(closest_names("", names).empty());
  CHECK(closest_names(std::string(100'000, 'x'), names).empty());
}
