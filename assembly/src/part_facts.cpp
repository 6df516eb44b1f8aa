// Facts about parts: what is placed, of what, where.

#include <array>
#include <map>

#include "fact_source.h"
#include "instance_boxes.h"

namespace dowel {
namespace {

FactValue number_or_null(const std::optional<double>& value) {
  return value ? FactValue(*value) : FactValue();
}

FactRows instances(FactSource& source) {
  FactRows rows;
  for (const auto& [name, instance] : source.state().instances) {
    const Element& element = source.element(instance);
    const Eigen::AlignedBox3d reach = box_around(instance, element);
    const Eigen::Vector3d& at = instance.X_WI.translation();
    const Eigen::Vector3d center = instance.X_WI * element.center_of_mass;
    rows.push_back({name, instance.element, element.family,
                    std::string(to_string(source.role(instance))), truth(instance.grounded),
                    number_or_null(element.mass_kg()), at.x(), at.y(), at.z(), center.x(),
                    center.y(), center.z(), reach.min().x(), reach.min().y(), reach.min().z(),
                    reach.max().x(), reach.max().y(), reach.max().z()});
  }
  return rows;
}

/// Elements of placed instances, with how many there are.
std::map<std::string, std::int64_t> used_elements(const ProjectState& state) {
  std::map<std::string, std::int64_t> counts;
  for (const auto& [name, instance] : state.instances) ++counts[instance.element];
  return counts;
}

FactRows elements(FactSource& source) {
  FactRows rows;
  for (const auto& [name, count] : used_elements(source.state())) {
    const Element& element = source.session().element(name);
    const Eigen::Vector3d size = 2.0 * element.obb.half_extents_mm;
    rows.push_back({name, element.family, text_or_null(element.role),
                    text_or_null(element.material), text_or_null(element.licence),
                    text_or_null(element.source), text_or_null(element.unit_in_file),
                    std::string(to_string(element.shape)), element.volume_mm3,
                    number_or_null(element.mass_kg()), size.x(), size.y(), size.z(), count});
  }
  return rows;
}

FactRows bom(FactSource& source) {
  FactRows rows;
  for (const auto& [name, count] : used_elements(source.state())) {
    const Element& element = source.session().element(name);
    rows.push_back({name, element.family, text_or_null(element.role), count});
  }
  return rows;
}

FactRows features(FactSource& source) {
  FactRows rows;
  for (const auto& [name, instance] : source.state().instances) {
    for (const Feature& feature : source.element(instance).features) {
      const Eigen::Vector3d at = instance.X_WI * feature.origin;
      const Eigen::Vector3d direction = instance.X_WI.rotation() * feature.direction;
      rows.push_back({name, feature.name, std::string(to_string(feature.kind)),
                      text_or_null(feature.use), text_or_null(feature.thread),
                      text_or_null(feature.fit), feature.diameter_mm, feature.depth_mm,
                      truth(feature.through), feature.area_mm2, at.x(), at.y(), at.z(),
                      direction.x(), direction.y(), direction.z()});
    }
  }
  return rows;
}

FactRows data_faults(FactSource& source) {
  FactRows rows;
  for (const auto& [name, count] : used_elements(source.state())) {
    for (const LintFinding& finding : source.data_faults(name)) {
      rows.push_back({name, finding.rule, finding.message});
    }
  }
  return rows;
}

}  // namespace

std::vector<FactTable> part_facts() {
  return {
      {"bom",
       "Elements in use and how many of each.",
       {{"element", "name"},
        {"family", "what stands before its last '/'"},
        {"role", "as its maker states it; NULL where nobody says"},
        {"count", "instances"}},
       FromParts,
       bom},
      {"data_faults",
       "What is wrong with the data of the elements in use (as `catalog lint` finds it).",
       {{"element", "name"}, {"rule", "CAT-01 to CAT-06"}, {"fault", "one sentence"}},
       FromParts,
       data_faults},
      {"elements",
       "Elements in use.",
       {{"element", "name"},
        {"family", "what stands before its last '/'"},
        {"role", "as its maker states it; NULL where nobody says"},
        {"material", "NULL where nobody says"},
        {"licence", "NULL where nobody says"},
        {"source", "file that it came from; NULL where nobody says"},
        {"unit_in_file", "NULL where nobody says"},
        {"shape", "block, cylinder, block-cylinder or compound"},
        {"volume_mm3", "of the exact solid"},
        {"mass_kg", "NULL where its density is not known"},
        {"box_x_mm", "sides of its smallest box"},
        {"box_y_mm", ""},
        {"box_z_mm", ""},
        {"count", "instances"}},
       FromParts,
       elements},
      {"features",
       "Named places of the placed parts, in the world.",
       {{"instance", "whose it is"},
        {"feature", "name"},
        {"kind", "hole, shaft, face or slot"},
        {"use", "what its maker calls it; NULL where nobody says"},
        {"thread", "M12, M12x1.5; NULL where there is none"},
        {"fit", "ISO 286 class; NULL where nobody says"},
        {"diameter_mm", "hole, shaft; slot: width"},
        {"depth_mm", "hole, slot: depth; shaft: length"},
        {"through", "1: open at both ends"},
        {"area_mm2", "faces"},
        {"x_mm", "opening of a hole, shoulder of a shaft, middle of a face"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"dx", "into the hole, to the free end of the shaft, out of the face; unit"},
        {"dy", ""},
        {"dz", ""}},
       FromParts,
       features},
      {"instances",
       "Placed parts.",
       {{"instance", "name"},
        {"element", "what it is"},
        {"family", "of the element"},
        {"role", "in the fixture: as given by the project, else by the catalogue"},
        {"grounded", "1: never moves"},
        {"mass_kg", "NULL where its density is not known"},
        {"x_mm", "origin"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"center_x_mm", "centre of mass"},
        {"center_y_mm", ""},
        {"center_z_mm", ""},
        {"min_x_mm", "box along the world's axes around its smallest box"},
        {"min_y_mm", ""},
        {"min_z_mm", ""},
        {"max_x_mm", ""},
        {"max_y_mm", ""},
        {"max_z_mm", ""}},
       FromParts | FromDesign,
       instances},
  };
}

}  // namespace dowel
