#include "result_codec.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "dowel/kernel/blob.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

constexpr std::uint64_t kMagic = 0x32'54'4c'53'52'57'4f'44;  // "DOWRSLT2"

class Writer {
 public:
  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    raw(&value, sizeof value);
  }
  void bytes(std::span<const std::byte> content) {
    number<std::uint64_t>(content.size());
    raw(content.data(), content.size());
  }
  void text(const std::string& content) {
    bytes(std::as_bytes(std::span(content.data(), content.size())));
  }
  std::vector<std::byte> take() { return std::move(out_); }

 private:
  void raw(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    out_.insert(out_.end(), first, first + size);
  }
  std::vector<std::byte> out_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> in) : in_(in) {}

  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    std::memcpy(&value, next(sizeof value).data(), sizeof value);
    return value;
  }
  std::span<const std::byte> bytes() { return next(number<std::uint64_t>()); }
  std::string text() {
    const std::span<const std::byte> content = bytes();
    return {reinterpret_cast<const char*>(content.data()), content.size()};
  }
  void expect_end() const {
    if (!in_.empty()) fail();
  }
  [[noreturn]] static void fail() {
    throw Error(ErrorCode::FileMalformed, "the import process sent a damaged result");
  }

 private:
  std::span<const std::byte> next(std::uint64_t size) {
    if (size > in_.size()) fail();
    const auto front = in_.first(static_cast<std::size_t>(size));
    in_ = in_.subspan(static_cast<std::size_t>(size));
    return front;
  }
  std::span<const std::byte> in_;
};

/// An enumerator that may be `last` at most.
template <class Enum>
Enum read_enum(Reader& in, Enum last) {
  const auto value = in.number<std::uint8_t>();
  if (value > static_cast<std::uint8_t>(last)) Reader::fail();
  return static_cast<Enum>(value);
}

template <class Enum>
void write_enum(Writer& out, Enum value) {
  out.number(static_cast<std::uint8_t>(value));
}

/// Calls `read` for each item. No reserve by a count that came from outside: the input's end bounds
/// the loop.
template <class Read>
void for_each_item(Reader& in, const Read& read) {
  for (auto count = in.number<std::uint64_t>(); count > 0; --count) read();
}

void write_vector(Writer& out, const Eigen::Vector3d& vector) {
  for (const double coordinate : vector) out.number(coordinate);
}

Eigen::Vector3d read_vector(Reader& in) {
  Eigen::Vector3d vector;
  for (double& coordinate : vector) coordinate = in.number<double>();
  return vector;
}

void encode_slot(Writer& out, const SlotShape& slot) {
  write_enum(out, slot.type);
  write_vector(out, slot.run);
  out.number(slot.length_mm);
  for (const SlotShape::End end : slot.ends) write_enum(out, end);
  out.number(slot.throat_depth_mm);
  out.number(slot.undercut_width_mm);
  out.number(slot.undercut_height_mm);
  out.number(slot.nominal_mm);
}

SlotShape decode_slot(Reader& in) {
  SlotShape slot;
  slot.type = read_enum(in, SlotShape::Type::Through);
  slot.run = read_vector(in);
  slot.length_mm = in.number<double>();
  for (SlotShape::End& end : slot.ends) end = read_enum(in, SlotShape::End::Round);
  slot.throat_depth_mm = in.number<double>();
  slot.undercut_width_mm = in.number<double>();
  slot.undercut_height_mm = in.number<double>();
  slot.nominal_mm = in.number<std::uint32_t>();
  return slot;
}

/// What only a manifest states (use, fit) is not known here.
void encode_feature(Writer& out, const Feature& feature) {
  out.text(feature.name);
  write_enum(out, feature.kind);
  write_vector(out, feature.origin);
  write_vector(out, feature.direction);
  for (const double value : {feature.diameter_mm, feature.depth_mm, feature.area_mm2}) {
    out.number(value);
  }
  for (const bool value : {feature.through, feature.thread_is_guess, feature.slot.has_value()}) {
    out.number(static_cast<std::uint8_t>(value));
  }
  for (const std::string& text : {feature.blind_end, feature.entry, feature.thread}) out.text(text);
  if (feature.slot) encode_slot(out, *feature.slot);
  out.number<std::uint64_t>(feature.segments.size());
  for (const HoleSegment& segment : feature.segments) {
    write_enum(out, segment.type);
    for (const double value :
         {segment.diameter_mm, segment.diameter_end_mm, segment.from_mm, segment.to_mm}) {
      out.number(value);
    }
  }
  out.number<std::uint64_t>(feature.faces.size());
  for (const std::uint32_t face : feature.faces) out.number(face);
}

Feature decode_feature(Reader& in) {
  Feature feature;
  feature.name = in.text();
  feature.kind = read_enum(in, FeatureKind::Slot);
  feature.origin = read_vector(in);
  feature.direction = read_vector(in);
  for (double* value : {&feature.diameter_mm, &feature.depth_mm, &feature.area_mm2}) {
    *value = in.number<double>();
  }
  feature.through = in.number<std::uint8_t>() != 0;
  feature.thread_is_guess = in.number<std::uint8_t>() != 0;
  const bool has_slot = in.number<std::uint8_t>() != 0;
  for (std::string* text : {&feature.blind_end, &feature.entry, &feature.thread}) {
    *text = in.text();
  }
  if (has_slot) feature.slot = decode_slot(in);
  for_each_item(in, [&] {
    HoleSegment& segment = feature.segments.emplace_back();
    segment.type = read_enum(in, HoleSegment::Type::Cone);
    for (double* value :
         {&segment.diameter_mm, &segment.diameter_end_mm, &segment.from_mm, &segment.to_mm}) {
      *value = in.number<double>();
    }
  });
  for_each_item(in, [&] { feature.faces.push_back(in.number<std::uint32_t>()); });
  return feature;
}

void encode_circle(Writer& out, const BoltCircle& circle) {
  write_vector(out, circle.center);
  write_vector(out, circle.direction);
  out.number(circle.diameter_mm);
  out.number(circle.hole_diameter_mm);
  out.number<std::uint64_t>(circle.holes.size());
  for (const std::string& hole : circle.holes) out.text(hole);
}

BoltCircle decode_circle(Reader& in) {
  BoltCircle circle;
  circle.center = read_vector(in);
  circle.direction = read_vector(in);
  circle.diameter_mm = in.number<double>();
  circle.hole_diameter_mm = in.number<double>();
  for_each_item(in, [&] { circle.holes.push_back(in.text()); });
  return circle;
}

void encode_recognised(Writer& out, const ImportedPart& part) {
  write_vector(out, part.obb.center);
  for (const double value : part.obb.axes.reshaped()) out.number(value);
  write_vector(out, part.obb.half_extents_mm);
  write_enum(out, part.shape);
  for (const std::uint32_t count :
       {part.triangles.total, part.triangles.plane, part.triangles.hole, part.triangles.other}) {
    out.number(count);
  }
  out.number<std::uint64_t>(part.features.size());
  for (const Feature& feature : part.features) encode_feature(out, feature);
  out.number<std::uint64_t>(part.bolt_circles.size());
  for (const BoltCircle& circle : part.bolt_circles) encode_circle(out, circle);
}

void decode_recognised(Reader& in, ImportedPart& part) {
  part.obb.center = read_vector(in);
  for (double& value : part.obb.axes.reshaped()) value = in.number<double>();
  part.obb.half_extents_mm = read_vector(in);
  const Eigen::Matrix3d skew =
      part.obb.axes.transpose() * part.obb.axes - Eigen::Matrix3d::Identity();
  // Written so that NaN is refused. Other numbers are checked with the whole element.
  if (!(skew.cwiseAbs().maxCoeff() <= kStoredAxisSlack) ||
      !(part.obb.half_extents_mm.minCoeff() >= 0.0) || !part.obb.center.allFinite()) {
    Reader::fail();
  }
  part.shape = read_enum(in, ShapeClass::Compound);
  for (std::uint32_t* count : {&part.triangles.total, &part.triangles.plane, &part.triangles.hole,
                               &part.triangles.other}) {
    *count = in.number<std::uint32_t>();
  }
  for_each_item(in, [&] {
    part.features.push_back(decode_feature(in));
    for (const std::uint32_t face : part.features.back().faces) {
      if (face >= part.solid.faces.size()) Reader::fail();
    }
  });
  for_each_item(in, [&] { part.bolt_circles.push_back(decode_circle(in)); });
}

void encode_part(Writer& out, const ImportedPart& part) {
  out.text(part.name);
  out.text(part.unit_in_file);
  out.bytes(to_blob(part.solid));
  out.number(part.volume_mm3);
  out.number(part.surface_mm2);
  for (const double coordinate : part.center_of_mass) out.number(coordinate);
  out.number<std::uint8_t>(part.colour ? 1 : 0);
  if (part.colour) {
    for (const double channel : *part.colour) out.number(channel);
  }
  out.bytes(part.brep);
  encode_recognised(out, part);
}

ImportedPart decode_part(Reader& in) {
  ImportedPart part;
  part.name = in.text();
  part.unit_in_file = in.text();
  part.solid = from_blob(in.bytes(), "import result");
  part.volume_mm3 = in.number<double>();
  part.surface_mm2 = in.number<double>();
  for (double& coordinate : part.center_of_mass) coordinate = in.number<double>();
  if (in.number<std::uint8_t>() != 0) {
    part.colour.emplace();
    for (double& channel : *part.colour) channel = in.number<double>();
  }
  const std::span<const std::byte> brep = in.bytes();
  part.brep.assign(brep.begin(), brep.end());
  decode_recognised(in, part);
  return part;
}

void encode_instance(Writer& out, const ImportedInstance& instance) {
  out.text(instance.name);
  out.number<std::uint64_t>(instance.part);
  const Eigen::Quaterniond& q = instance.X_WI.rotation();
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) out.number(value);
  for (const double value : instance.X_WI.translation()) out.number(value);
}

ImportedInstance decode_instance(Reader& in, std::size_t part_count) {
  ImportedInstance instance;
  instance.name = in.text();
  const auto part = in.number<std::uint64_t>();
  if (part >= part_count) Reader::fail();
  instance.part = static_cast<std::size_t>(part);
  std::array<double, 4> q{};
  Eigen::Vector3d translation;
  for (double& value : q) value = in.number<double>();
  for (double& value : translation) value = in.number<double>();
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  // Written so that NaN is refused.
  if (!(std::abs(rotation.norm() - 1.0) <= kUnitQuaternionSlack) || !translation.allFinite()) {
    Reader::fail();
  }
  instance.X_WI = Pose(rotation, translation);
  return instance;
}

}  // namespace

std::vector<std::byte> encode(const ImportResult& result) {
  Writer out;
  out.number(kMagic);
  out.number(static_cast<std::uint8_t>(result.status));
  out.text(result.reason);
  out.number<std::uint64_t>(result.warnings.size());
  for (const std::string& warning : result.warnings) out.text(warning);
  out.number<std::uint64_t>(result.parts.size());
  for (const ImportedPart& part : result.parts) encode_part(out, part);
  out.number<std::uint64_t>(result.instances.size());
  for (const ImportedInstance& instance : result.instances) encode_instance(out, instance);
  return out.take();
}

ImportResult decode_result(std::span<const std::byte> bytes) {
  Reader in(bytes);
  if (in.number<std::uint64_t>() != kMagic) Reader::fail();
  ImportResult result;
  const auto status = in.number<std::uint8_t>();
  if (status > static_cast<std::uint8_t>(ImportResult::Status::Failed)) Reader::fail();
  result.status = static_cast<ImportResult::Status>(status);
  result.reason = in.text();
  // No reserve by a count that came from outside: the input's end bounds the loop.
  for (auto count = in.number<std::uint64_t>(); count > 0; --count) {
    result.warnings.push_back(in.text());
  }
  for (auto count = in.number<std::uint64_t>(); count > 0; --count) {
    result.parts.push_back(decode_part(in));
  }
  for (auto count = in.number<std::uint64_t>(); count > 0; --count) {
    result.instances.push_back(decode_instance(in, result.parts.size()));
  }
  in.expect_end();
  return result;
}

}  // namespace dowel
