#include <filesystem>
#include <string>

#include <catch2/catch.hpp>

#include "dowel/io/import.h"
#include "program.h"
#include "step_definitions.h"

namespace dowel {
namespace {

using testing::TemporaryFolder;
using testing::write_text;

std::string step_of(const std::string& entities) {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','',''"
         ");"
         "\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n" +
         entities + "ENDSEC;\nEND-ISO-10303-21;\n";
}

constexpr const char* kReferences =
    "#9001 = DOCUMENT_FILE('wheel.stp','','',#9003,'',$);\n"
    "#9002=DOCUMENT_FILE('axle.stp','','',#9003,'',$);\n#9003=DOCUMENT_TYPE('');\n";

}  // namespace

TEST_CASE("a file that only refers to other files says so") {
  const TemporaryFolder folder;
  write_text(folder / "assembly.stp", step_of(kReferences));
  const ImportResult result = import_file(folder / "assembly.stp", {});
  CHECK(result.status == ImportResult::Status::Empty);
  CHECK(result.reason == "2 external references, no solid");
}

TEST_CASE("a file that has parts and refers to other files warns of them") {
  const std::filesystem::path real =
      std::filesystem::path(DOWEL_SHARED_STEP) / "stepnode/simple_block_workpiece.stp";
  if (!std::filesystem::exists(real)) {
    WARN("no folder of real STEP files here: " << DOWEL_SHARED_STEP);
    return;
  }
  const TemporaryFolder folder;
  std::string text = testing::read_text(real);
  text.insert(text.rfind("ENDSEC;"), kReferences);
  write_text(folder / "assembly.stp", text);
  const ImportResult result = import_file(folder / "assembly.stp", {});
  CHECK(result.status == ImportResult::Status::Ok);
  REQUIRE(result.warnings.size() == 1);
  CHECK(result.warnings[0] == "has 2 external references: parts in other files may be missing");
}

TEST_CASE("a placement or shape that nothing refers to is counted, whatever strings hold") {
  const std::string used =
      "#1=NEXT_ASSEMBLY_USAGE_OCCURRENCE('a;#7','','',#4,#5,$);"
      "#2=(REPRESENTATION_RELATIONSHIP('','',#6,#7)REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"
      "(#8)SHAPE_REPRESENTATION_RELATIONSHIP());"
      "#3=PRODUCT_DEFINITION_SHAPE('','',#1);";
  const std::string both = used + "#9=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#2,#3);";
  CHECK(unused_definitions("HEADER;ENDSEC;DATA;" + both + "ENDSEC;") == 0);
  CHECK(unused_definitions("HEADER;ENDSEC;DATA;" + used + "ENDSEC;") == 2);
  CHECK(unused_definitions("DATA;#1=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#4,#5,$)") == 1);
  CHECK(unused_definitions("DATA;#;#=;##1=#") == 0);
  CHECK(unused_definitions("") == 0);
}

}  // namespace dowel
