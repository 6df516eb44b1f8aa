// Prints what moves of many kinds were judged to be, for builds to be compared: with and without
// SIMD, verdicts are the same.

#include <cstdint>
#include <cstdio>
#include <string_view>

#include "surroundings.h"

namespace {

constexpr int kMoves = 35'000;  // each past six bodies
constexpr int kMovesOfLine = 1'000;

/// Source: Fowler, Noll, Vo, FNV-1a.
std::uint64_t digest(std::uint64_t hash, std::string_view text) {
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }
  return hash;
}

void print_digest(int kind) {
  using namespace dowel::testing;
  RandomGeometry random(91);
  Surroundings world;
  const dowel::BodyId moving = world.scene.add(collision_element(mover(kind)), dowel::Pose());
  dowel::Pose pose = anchor(random);
  std::uint64_t hash = 0xcbf29ce484222325U;
  int met = 0;
  for (int i = 1; i <= kMoves; ++i) {
    pose = next(random, pose);
    const std::string verdicts = told(world.scene.check({&moving, 1}, {&pose, 1}, {}));
    hash = digest(digest(hash, verdicts), ";");
    met += verdicts.empty() ? 0 : 1;
    if (i % kMovesOfLine != 0) continue;
    std::printf("mover %d, %5d moves: %5d met something, %016llx\n", kind, i, met,
                static_cast<unsigned long long>(hash));
  }
}

}  // namespace

int main() {
  for (const int kind : {0, 1, 2}) print_digest(kind);
}
