// Damaged copies of STEP files: whatever is wrong with them, the import ends with an answer, and
// what it takes in is either what was meant or carries a flag.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/io/import.h"
#include "dowel/io/step_writer.h"
#include "dowel/kernel/mesh_defect.h"
#include "program.h"
#include "random_geometry.h"
#include "step_files.h"

namespace dowel {
namespace {

using Status = ImportResult::Status;

/// A whole file, and what is right about it.
struct Original {
  std::string name;
  std::string text;
  ImportResult result;
};

/// Lines of the data section that begin an entity: "#12=".
std::vector<std::pair<std::size_t, std::size_t>> entities_of(const std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> entities;
  std::size_t at = text.find("DATA;");
  while (at != text.npos && (at = text.find("\n#", at)) != text.npos) {
    const std::size_t end = text.find(';', at);
    if (end == text.npos) break;
    entities.emplace_back(at + 1, end + 1);
    at = end;
  }
  return entities;
}

std::string truncated(const std::string& text, testing::RandomGeometry& random) {
  return text.substr(0, random.index(static_cast<std::uint32_t>(text.size())));
}

std::string bits_flipped(std::string text, testing::RandomGeometry& random) {
  for (std::uint32_t flips = 1 + random.index(4); flips > 0; --flips) {
    char& hit = text[random.index(static_cast<std::uint32_t>(text.size()))];
    hit = static_cast<char>(static_cast<unsigned char>(hit) ^ (1U << random.index(8)));
  }
  return text;
}

std::string entity_deleted(std::string text, testing::RandomGeometry& random) {
  const auto entities = entities_of(text);
  const auto [from, to] = entities[random.index(static_cast<std::uint32_t>(entities.size()))];
  return text.erase(from, to - from);
}

/// What two entities are changes places; their numbers stay.
std::string entities_swapped(const std::string& text, testing::RandomGeometry& random) {
  const auto entities = entities_of(text);
  const auto count = static_cast<std::uint32_t>(entities.size());
  auto [a, b] = std::minmax(random.index(count), random.index(count));
  const auto body = [&](std::uint32_t i) {
    const std::size_t from = text.find('=', entities[i].first) + 1;
    return std::pair(from, entities[i].second);
  };
  if (a == b) return entity_deleted(text, random);
  const auto [a_from, a_to] = body(a);
  const auto [b_from, b_to] = body(b);
  return text.substr(0, a_from) + text.substr(b_from, b_to - b_from) +
         text.substr(a_to, b_from - a_to) + text.substr(a_from, a_to - a_from) + text.substr(b_to);
}

std::string damaged(const std::string& text, std::size_t kind, testing::RandomGeometry& random) {
  switch (kind % 4) {
    case 0:
      return truncated(text, random);
    case 1:
      return bits_flipped(text, random);
    case 2:
      return entity_deleted(text, random);
    default:
      return entities_swapped(text, random);
  }
}

Original original_of(const std::filesystem::path& file) {
  Original original{file.filename().string(), testing::read_text(file), import_file(file, {})};
  REQUIRE(original.result.status == Status::Ok);
  return original;
}

/// Two files of our own writer, and two real ones where they are at hand.
std::vector<Original> originals(const testing::TemporaryFolder& folder) {
  testing::write_step(folder / "plate-in.step", {testing::drilled_plate()});
  const ImportResult plate = import_file(folder / "plate-in.step", {});
  REQUIRE(plate.status == Status::Ok);
  const ExportPart part{"plate", plate.parts.front().brep, {}};
  write_step_part(folder / "plate.step", part);
  write_step_assembly(folder / "stack.step", "stack", {part},
                      {{"lower", 0, Pose()}, {"upper", 0, Pose::from_translation({0, 0, 10})}});
  std::vector<Original> result{original_of(folder / "plate.step"),
                               original_of(folder / "stack.step")};
  const std::filesystem::path shared = DOWEL_SHARED_STEP;
  for (const char* name : {"fcl2015/ISO4762_Hex_Socket_Head_Cap_Screw_M6x12.step",
                           "stepnode/simple_block_workpiece.stp"}) {
    if (std::filesystem::exists(shared / name)) result.push_back(original_of(shared / name));
  }
  return result;
}

/// Whether two imports describe the same parts at the same places.
bool is_same(const ImportResult& a, const ImportResult& b) {
  if (a.parts.size() != b.parts.size() || a.instances.size() != b.instances.size()) return false;
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    const ImportedPart& p = a.parts[i];
    const ImportedPart& q = b.parts[i];
    if (p.solid.faces.size() != q.solid.faces.size() ||
        std::abs(p.volume_mm3 - q.volume_mm3) > 1e-9 * q.volume_mm3 ||
        (p.center_of_mass - q.center_of_mass).norm() > 1e-9) {
      return false;
    }
  }
  for (std::size_t i = 0; i < a.instances.size(); ++i) {
    const Pose X = a.instances[i].X_WI.inverse() * b.instances[i].X_WI;
    if (X.translation().norm() > 1e-9) return false;
  }
  return true;
}

struct Tally {
  std::size_t failed = 0;
  std::size_t flagged = 0;
  std::size_t same = 0;
};

/// Which of the originals variant `i` is made of: three of four from our own writer's.
std::size_t original_of_variant(std::size_t i) {
  const std::size_t turn = i / 4 % 8;
  return turn < 6 ? turn % 2 : turn - 4;
}

/// `own_count` damaged copies of our own files, and a third of that of the real ones.
Tally import_damaged(std::size_t own_count) {
  const testing::TemporaryFolder folder;
  const std::vector<Original> whole = originals(folder);
  std::vector<std::filesystem::path> files;
  std::vector<std::size_t> variant_of;
  for (std::size_t i = 0; i < own_count * 4 / 3; ++i) {
    if (original_of_variant(i) >= whole.size()) continue;
    testing::RandomGeometry random(i);  // the same variants whatever files are at hand
    files.push_back(folder / ("damaged" + std::to_string(i) + ".step"));
    testing::write_text(files.back(), damaged(whole[original_of_variant(i)].text, i, random));
    variant_of.push_back(i);
  }
  Tally tally;
  std::size_t next = 0;
  import_files(files, {.max_seconds = 20.0}, 2, [&](std::size_t i, ImportResult&& result) {
    const Original& original = whole[original_of_variant(variant_of[i])];
    CAPTURE(variant_of[i], original.name, result.reason);
    CHECK(i == next++);
    CHECK(result.reason.empty() == (result.status == Status::Ok));
    CHECK_THAT(result.reason, !Catch::Contains("time limit"));
    for (const ImportedPart& part : result.parts) CHECK_FALSE(find_defect(part.solid));
    if (result.status != Status::Ok) {
      ++tally.failed;
    } else if (!result.warnings.empty()) {
      ++tally.flagged;
    } else if (is_same(result, original.result)) {
      ++tally.same;
    } else {
      FAIL_CHECK("something else than was meant, without a flag");
    }
    return true;
  });
  CHECK(next == files.size());
  return tally;
}

}  // namespace

TEST_CASE("damaged files fail, carry a flag or give what was meant", "[fault]") {
  const Tally tally = import_damaged(36);
  CHECK(tally.failed > 10);
  CHECK(tally.flagged > 3);
}

// A minute: run by name or tag.
TEST_CASE("300 damaged files fail, carry a flag or give what was meant", "[.slow][fault]") {
  const Tally tally = import_damaged(300);
  CHECK(tally.failed > 100);
  CHECK(tally.flagged > 30);
  CHECK(tally.same > 5);
}

}  // namespace dowel
