#include "dowel/kernel/blob.h"

#include <bit>
#include <limits>
#include <optional>
#include <string>

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "solids.h"

namespace {

using namespace dowel;
using namespace dowel::testing;

FacetedSolid one_of_everything() {
  DrilledHole hole;
  hole.radius_mm = 2.0;
  FacetedSolid s = merged(plate_with_holes({10, 8, 2}, {hole}, 5), cone(2, 3, 5));
  s.faces[3].surface = OtherSurface{};
  s.faces[4].surface = TorusSurface{{1, 2, 3}, {0, 1, 0}, 5.0, 1.5};
  s.faces[5].surface = SphereSurface{{1, 2, 3}, 0.1};
  s.faces[5].facet_error_mm = 0.1 + 0.2;
  s.vertices[0].x() = -0.0;
  s.vertices[1].x() = std::numeric_limits<double>::denorm_min();
  s.edges[2].convexity = Convexity::Smooth;
  s.edges[3].curve = CurveKind::Other;
  return s;
}

/// The outcome of reading: an error code, or nothing where the bytes were accepted.
std::optional<ErrorCode> outcome(const std::vector<std::byte>& blob) {
  try {
    from_blob(blob, "element plate");
  } catch (const Error& error) {
    REQUIRE_THAT(error.what(), Catch::StartsWith("element plate: "));
    return error.code();
  }
  return std::nullopt;
}

/// The checksum, bit by bit: an oracle for the one under test.
std::uint32_t slow_crc32c(std::span<const std::byte> bytes) {
  std::uint32_t rest = ~0U;
  for (const std::byte byte : bytes) {
    rest ^= std::to_integer<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? 0x82F63B78U : 0U);
    }
  }
  return ~rest;
}

/// With a checksum that fits: what an attacker writes.
void seal(std::vector<std::byte>& blob) {
  const std::uint32_t crc = slow_crc32c(std::span(blob).subspan(12));
  for (std::size_t i = 0; i < 4; ++i) blob[8 + i] = static_cast<std::byte>((crc >> (8 * i)) & 255U);
}

}  // namespace

TEST_CASE("a solid comes back to the bit") {
  const FacetedSolid s = one_of_everything();
  const std::vector<std::byte> blob = to_blob(s);
  const FacetedSolid back = from_blob(blob, "element plate");
  CHECK(to_blob(back) == blob);
  CHECK(back.vertices.size() == s.vertices.size());
  for (std::size_t i = 0; i < s.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      REQUIRE(std::bit_cast<std::uint64_t>(back.vertices[i][k]) ==
              std::bit_cast<std::uint64_t>(s.vertices[i][k]));
    }
  }
  CHECK(back.triangles == s.triangles);
  CHECK(back.face_of == s.face_of);
  CHECK(back.solid_count == 2);
  REQUIRE(back.faces.size() == s.faces.size());
  for (std::size_t i = 0; i < s.faces.size(); ++i) {
    REQUIRE(back.faces[i].surface.index() == s.faces[i].surface.index());
    REQUIRE(back.faces[i].reversed == s.faces[i].reversed);
    REQUIRE(back.faces[i].facet_error_mm == s.faces[i].facet_error_mm);
    REQUIRE(back.faces[i].area_mm2 == s.faces[i].area_mm2);
    REQUIRE(back.faces[i].solid == s.faces[i].solid);
  }
  CHECK(std::get<TorusSurface>(back.faces[4].surface).minor_radius_mm == 1.5);
  CHECK(std::get<SphereSurface>(back.faces[5].surface).radius_mm == 0.1);
  REQUIRE(back.edges.size() == s.edges.size());
  for (std::size_t i = 0; i < s.edges.size(); ++i) {
    REQUIRE(back.edges[i].faces == s.edges[i].faces);
    REQUIRE(back.edges[i].convexity == s.edges[i].convexity);
    REQUIRE(back.edges[i].curve == s.edges[i].curve);
    REQUIRE(back.edges[i].closed == s.edges[i].closed);
    REQUIRE(back.edges[i].length_mm == s.edges[i].length_mm);
    REQUIRE(back.edges[i].center == s.edges[i].center);
    REQUIRE(back.edges[i].radius_mm == s.edges[i].radius_mm);
  }
}

TEST_CASE("the layout is the documented one", "[golden]") {
  const std::vector<std::byte> blob = to_blob(FacetedSolid());
  REQUIRE(blob.size() == 44);
  CHECK(std::string(reinterpret_cast<const char*>(blob.data()), 8) == "dwlsolid");
  CHECK(blob[12] == std::byte{1});
  CHECK(blob[16] == std::byte{20});
  std::vector<std::byte> sealed = blob;
  seal(sealed);
  CHECK(sealed == blob);
  CHECK(outcome(blob) == std::nullopt);
}

TEST_CASE("a blob cut anywhere is refused", "[fault]") {
  const std::vector<std::byte> blob = to_blob(one_of_everything());
  for (std::size_t size = 0; size < blob.size(); ++size) {
    CAPTURE(size);
    const std::vector<std::byte> cut(blob.begin(),
                                     blob.begin() + static_cast<std::ptrdiff_t>(size));
    REQUIRE(outcome(cut) == ErrorCode::FileMalformed);
  }
  std::vector<std::byte> longer = blob;
  longer.push_back(std::byte{0});
  CHECK(outcome(longer) == ErrorCode::FileMalformed);
}

TEST_CASE("a blob with any bit flipped is refused", "[fault]") {
  std::vector<std::byte> blob = to_blob(box({1, 2, 3}));
  for (std::size_t bit = 0; bit < 8 * blob.size(); ++bit) {
    blob[bit / 8] ^= std::byte{1} << (bit % 8);
    CAPTURE(bit);
    REQUIRE(outcome(blob).has_value());
    blob[bit / 8] ^= std::byte{1} << (bit % 8);
  }
  CHECK(outcome(blob) == std::nullopt);
}

TEST_CASE("a blob forged with a fitting checksum is refused or harmless", "[fault]") {
  const std::vector<std::byte> blob = to_blob(one_of_everything());
  RandomGeometry random(11);
  std::size_t refused = 0;
  constexpr std::size_t kRounds = 4000;
  for (std::size_t round = 0; round < kRounds; ++round) {
    std::vector<std::byte> forged = blob;
    for (std::uint32_t changes = 1 + random.index(3); changes > 0; --changes) {
      // Half of the changes hit the counts, where they hurt most.
      const auto size = static_cast<std::uint32_t>(forged.size());
      const std::size_t at = random.coin() ? 24 + random.index(20) : 12 + random.index(size - 12);
      forged[at] = static_cast<std::byte>(random.index(256));
    }
    if (random.index(4) == 0) forged.resize(24 + random.index(400));
    seal(forged);
    if (outcome(forged).has_value()) {
      ++refused;
    } else {
      const FacetedSolid solid = from_blob(forged, "element plate");
      for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
        REQUIRE(solid.corners(i)[2].allFinite());
        REQUIRE(solid.faces.at(solid.face_of[i]).solid < solid.solid_count);
      }
    }
  }
  CHECK(refused > kRounds / 4);
  CHECK(refused < kRounds);
}

TEST_CASE("a newer version is told apart from damage") {
  std::vector<std::byte> blob = to_blob(box({1, 2, 3}));
  blob[12] = std::byte{2};
  seal(blob);
  CHECK(outcome(blob) == ErrorCode::SchemaMismatch);
  blob[12] = std::byte{0};
  seal(blob);
  CHECK(outcome(blob) == ErrorCode::FileMalformed);
}
