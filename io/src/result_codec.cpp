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

constexpr std::uint64_t kMagic = 0x31'54'4c'53'52'57'4f'44;  // "DOWRSLT1"

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
