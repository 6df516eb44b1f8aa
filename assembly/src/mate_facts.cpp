// Facts about mates, and the rules' own settings.

#include <numbers>
#include <set>

#include "fact_source.h"

namespace dowel {
namespace {

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;

FactRows mates(FactSource& source) {
  FactRows rows;
  for (const auto& [number, mate] : source.state().mates) {
    const MateResidual off = source.session().residual(mate);
    rows.push_back(
        {std::int64_t{number}, std::string(to_string(mate.kind)), mate.moving.instance,
         text_or_null(mate.moving.feature), mate.fixed.instance, text_or_null(mate.fixed.feature),
         mate.has_seat() ? FactValue(mate.fixed_face.instance) : FactValue(), truth(mate.thread),
         mate.offset_mm, off.axis_mm, off.angle_rad * kDegrees_per_rad, off.along_mm});
  }
  return rows;
}

FactRows freedoms(FactSource& source) {
  std::set<std::string> mated;
  for (const auto& [number, mate] : source.state().mates) {
    mated.insert(mate.moving.instance);
    mated.insert(mate.fixed.instance);
  }
  FactRows rows;
  for (const std::string& name : mated) {
    const FreedomReport report = source.session().freedoms(name);
    std::int64_t slides = 0;
    std::int64_t turns = 0;
    for (const Freedom& freedom : report.freedoms) {
      ++(freedom.kind == Freedom::Kind::Slide ? slides : turns);
    }
    rows.push_back({name, slides, turns,
                    report.relative_to.empty() ? FactValue() : FactValue(report.relative_to)});
  }
  return rows;
}

FactRows limit_rows(FactSource& source) {
  FactRows rows;
  const FixtureDesign& design = source.state().design;
  for (const Limit& limit : limits()) {
    const std::string name(limit.name);
    rows.push_back({name, design.limit(name), truth(design.limits.contains(name)),
                    std::string(limit.meaning)});
  }
  return rows;
}

}  // namespace

std::vector<FactTable> mate_facts() {
  return {
      {"freedoms",
       "How parts that have mates can still move by them.",
       {{"instance", "name"},
        {"slides", "directions in which it can slide"},
        {"turns", "axes about which it can turn"},
        {"against", "part that this is told against where no grounded one is in reach; else NULL"}},
       FromParts | FromMates,
       freedoms},
      {"mates",
       "Mates that the project holds.",
       {{"number", "order of making"},
        {"kind", "shaft in hole, face on face, ..."},
        {"moving", "instance that went"},
        {"moving_feature", "NULL: the whole part"},
        {"fixed", "instance that it went to"},
        {"fixed_feature", "NULL: the whole part"},
        {"seat", "instance that it is seated on; NULL where there is none"},
        {"thread", "1: shaft and hole form a thread"},
        {"offset_mm", "that was asked for"},
        {"off_axis_mm", "by how much it is missed now"},
        {"off_angle_deg", ""},
        {"off_along_mm", ""}},
       FromParts | FromMates,
       mates},
  };
}

std::vector<FactTable> design_facts() {
  return {{"limits",
           "What rules compare with; `limit NAME VALUE` changes them.",
           {{"name", "ends in its unit"},
            {"value", "in force"},
            {"given", "1: by the project; 0: the usual one"},
            {"meaning", "one line"}},
           FromDesign,
           limit_rows}};
}

}  // namespace dowel
