#include "dowel/kernel/blob.h"

#include <array>
#include <bit>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "crc32c.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "solid_values.h"

// Layout, all little-endian:
//   8 bytes   magic
//   u32       CRC-32C of all that follows
//   u32       version
//   u64       bytes in the body
//   body      u32 counts of vertices, triangles, faces, edges, solids; then vertices (3 f64),
//             triangles (3 u32), face indices (u32), faces, edges

namespace dowel {
namespace {

constexpr std::string_view kMagic{"dwlsolid", 8};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kChecked = kMagic.size() + 4;  // where the checksum starts
constexpr std::size_t kHeaderSize = kChecked + 4 + 8;
constexpr std::size_t kCountsSize = std::size_t{5} * 4;
constexpr std::size_t kVertexSize = std::size_t{3} * 8;
constexpr std::size_t kTriangleSize = std::size_t{4} * 4;  // with its face index
constexpr std::size_t kMinFaceSize = 1 + 1 + 8 + 8 + 4;
constexpr std::size_t kMaxFaceSize =
    kMinFaceSize + std::size_t{8} * 8;  // with the parameters of a torus
constexpr std::size_t kEdgeSize = 2 * 4 + 3 + 8 + 4 * kVertexSize + 8;

class Writer {
 public:
  void u8(std::uint8_t value) { bytes_.push_back(std::byte{value}); }
  void u32(std::uint32_t value) { unsigned_value(value); }
  void u64(std::uint64_t value) { unsigned_value(value); }
  void f64(double value) { unsigned_value(std::bit_cast<std::uint64_t>(value)); }
  void vector(const Eigen::Vector3d& v) {
    for (const double x : {v.x(), v.y(), v.z()}) f64(x);
  }

  void append(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  std::vector<std::byte>& bytes() { return bytes_; }

 private:
  template <class Unsigned>
  void unsigned_value(Unsigned value) {
    std::array<std::byte, sizeof(Unsigned)> packed{};
    for (std::size_t i = 0; i < packed.size(); ++i) {
      packed[i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFU);
    }
    bytes_.insert(bytes_.end(), packed.begin(), packed.end());
  }

  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const char* what) : bytes_(bytes), what_(what) {}

  std::uint8_t u8() { return std::to_integer<std::uint8_t>(take(1)[0]); }
  std::uint32_t u32() { return unsigned_value<std::uint32_t>(); }
  std::uint64_t u64() { return unsigned_value<std::uint64_t>(); }
  double f64() { return std::bit_cast<double>(u64()); }
  Eigen::Vector3d vector() {
    const double x = f64();
    const double y = f64();
    const double z = f64();
    return {x, y, z};
  }
  bool flag(const char* name) { return enumerator(1, name) != 0; }

  /// A number from 0 to `last`.
  std::uint8_t enumerator(std::uint8_t last, const char* name) {
    const std::uint8_t value = u8();
    if (value > last) {
      fail(std::string(name) + " is " + std::to_string(value) + ", expected 0 to " +
           std::to_string(last));
    }
    return value;
  }

  /// A number of things of at least `size` bytes each that the rest can hold, so that a false
  /// count cannot ask for memory.
  std::size_t count(std::uint32_t declared, std::size_t size, const char* name) const {
    if (declared > rest() / size) {
      fail("it announces " + std::to_string(declared) + " " + name + " in " +
           std::to_string(rest()) + " bytes");
    }
    return declared;
  }

  std::span<const std::byte> take(std::size_t size) {
    if (size > rest()) {
      fail("it ends after " + std::to_string(bytes_.size()) + " bytes, expected more");
    }
    const std::span<const std::byte> result = bytes_.subspan(at_, size);
    at_ += size;
    return result;
  }

  std::size_t rest() const { return bytes_.size() - at_; }

  [[noreturn]] void fail(const std::string& reason,
                         ErrorCode code = ErrorCode::FileMalformed) const {
    throw Error(code, std::string(what_) + ": its stored solid is not usable, " + reason);
  }

 private:
  template <class Unsigned>
  Unsigned unsigned_value() {
    Unsigned value = 0;
    const std::span<const std::byte> packed = take(sizeof(Unsigned));
    for (std::size_t i = 0; i < packed.size(); ++i) {
      value |= std::to_integer<Unsigned>(packed[i]) << (8 * i);
    }
    return value;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  const char* what_;
};

/// The alternatives of Surface are numbered by their place in it; the numbers are part of the
/// format.
static_assert(std::is_same_v<Surface, std::variant<OtherSurface, PlaneSurface, CylinderSurface,
                                                   ConeSurface, SphereSurface, TorusSurface>>);

constexpr std::uint8_t kSurfaceKinds = std::variant_size_v<Surface>;

struct WriteSurface {
  Writer& out;

  void operator()(const OtherSurface&) const {}
  void operator()(const PlaneSurface& s) const {
    out.vector(s.origin);
    out.vector(s.normal);
  }
  void operator()(const CylinderSurface& s) const {
    out.vector(s.origin);
    out.vector(s.axis);
    out.f64(s.radius_mm);
  }
  void operator()(const ConeSurface& s) const {
    out.vector(s.apex);
    out.vector(s.axis);
    out.f64(s.half_angle_rad);
  }
  void operator()(const SphereSurface& s) const {
    out.vector(s.center);
    out.f64(s.radius_mm);
  }
  void operator()(const TorusSurface& s) const {
    out.vector(s.center);
    out.vector(s.axis);
    out.f64(s.major_radius_mm);
    out.f64(s.minor_radius_mm);
  }
};

// Braces evaluate from left to right, so that the parameters are read in the order of the fields.
Surface read_surface(Reader& in) {
  switch (in.enumerator(kSurfaceKinds - 1, "the kind of a surface")) {
    case 1:
      return PlaneSurface{in.vector(), in.vector()};
    case 2:
      return CylinderSurface{in.vector(), in.vector(), in.f64()};
    case 3:
      return ConeSurface{in.vector(), in.vector(), in.f64()};
    case 4:
      return SphereSurface{in.vector(), in.f64()};
    case 5:
      return TorusSurface{in.vector(), in.vector(), in.f64(), in.f64()};
    default:
      return OtherSurface{};
  }
}

void write_face(Writer& out, const Face& face) {
  out.u8(static_cast<std::uint8_t>(face.surface.index()));
  std::visit(WriteSurface{out}, face.surface);
  out.u8(face.reversed ? 1 : 0);
  out.f64(face.facet_error_mm);
  out.f64(face.area_mm2);
  out.u32(face.solid);
}

Face read_face(Reader& in) {
  Face face;
  face.surface = read_surface(in);
  face.reversed = in.flag("the reversed mark of a face");
  face.facet_error_mm = in.f64();
  face.area_mm2 = in.f64();
  face.solid = in.u32();
  return face;
}

void write_edge(Writer& out, const Edge& edge) {
  out.u32(edge.faces[0]);
  out.u32(edge.faces[1]);
  out.u8(static_cast<std::uint8_t>(edge.convexity));
  out.u8(static_cast<std::uint8_t>(edge.curve));
  out.u8(edge.closed ? 1 : 0);
  out.f64(edge.length_mm);
  out.vector(edge.start);
  out.vector(edge.end);
  out.vector(edge.center);
  out.vector(edge.axis);
  out.f64(edge.radius_mm);
}

Edge read_edge(Reader& in) {
  Edge edge;
  edge.faces = {in.u32(), in.u32()};
  edge.convexity = static_cast<Convexity>(
      in.enumerator(static_cast<std::uint8_t>(Convexity::Smooth), "the convexity of an edge"));
  edge.curve = static_cast<CurveKind>(
      in.enumerator(static_cast<std::uint8_t>(CurveKind::Other), "the curve of an edge"));
  edge.closed = in.flag("the closed mark of an edge");
  edge.length_mm = in.f64();
  edge.start = in.vector();
  edge.end = in.vector();
  edge.center = in.vector();
  edge.axis = in.vector();
  edge.radius_mm = in.f64();
  return edge;
}

/// Checks everything that is not the body.
Reader open_body(std::span<const std::byte> blob, const char* what) {
  Reader in(blob, what);
  if (blob.size() < kHeaderSize) {
    in.fail("it has " + std::to_string(blob.size()) + " bytes, expected at least " +
            std::to_string(kHeaderSize));
  }
  for (const char expected : kMagic) {
    if (in.u8() != static_cast<std::uint8_t>(expected))
      in.fail("it does not start as a solid does");
  }
  const std::uint32_t checksum = in.u32();
  const std::uint32_t version = in.u32();
  if (version > kVersion) {
    in.fail("it has version " + std::to_string(version) + " and this program reads up to " +
                std::to_string(kVersion),
            ErrorCode::SchemaMismatch);
  }
  const std::uint64_t size = in.u64();
  if (version == 0 || size != in.rest()) {
    in.fail("its body has " + std::to_string(in.rest()) + " bytes, expected " +
            std::to_string(size) + " of version " + std::to_string(kVersion));
  }
  if (crc32c(blob.subspan(kChecked)) != checksum) in.fail("its checksum does not match");
  return in;
}

std::uint32_t to_count(std::size_t size) {
  DOWEL_EXPECTS(size <= std::numeric_limits<std::uint32_t>::max());
  return static_cast<std::uint32_t>(size);
}

}  // namespace

std::vector<std::byte> to_blob(const FacetedSolid& solid) {
  DOWEL_EXPECTS(solid.face_of.size() == solid.triangles.size());
  Writer body;
  body.reserve(kCountsSize + solid.vertices.size() * kVertexSize +
               solid.triangles.size() * kTriangleSize + solid.faces.size() * kMaxFaceSize +
               solid.edges.size() * kEdgeSize);
  body.u32(to_count(solid.vertices.size()));
  body.u32(to_count(solid.triangles.size()));
  body.u32(to_count(solid.faces.size()));
  body.u32(to_count(solid.edges.size()));
  body.u32(solid.solid_count);
  for (const Eigen::Vector3d& vertex : solid.vertices) body.vector(vertex);
  for (const Triangle& triangle : solid.triangles) {
    for (const std::uint32_t vertex : triangle) body.u32(vertex);
  }
  for (const std::uint32_t face : solid.face_of) body.u32(face);
  for (const Face& face : solid.faces) write_face(body, face);
  for (const Edge& edge : solid.edges) write_edge(body, edge);

  Writer checked;
  checked.reserve(kHeaderSize - kChecked + body.bytes().size());
  checked.u32(kVersion);
  checked.u64(body.bytes().size());
  checked.append(body.bytes());

  Writer blob;
  blob.reserve(kChecked + checked.bytes().size());
  for (const char c : kMagic) blob.u8(static_cast<std::uint8_t>(c));
  blob.u32(crc32c(checked.bytes()));
  blob.append(checked.bytes());
  return std::move(blob.bytes());
}

FacetedSolid from_blob(std::span<const std::byte> blob, const char* what) {
  Reader in = open_body(blob, what);
  const std::uint32_t vertex_count = in.u32();
  const std::uint32_t triangle_count = in.u32();
  const std::uint32_t face_count = in.u32();
  const std::uint32_t edge_count = in.u32();

  FacetedSolid solid;
  solid.solid_count = in.u32();
  solid.vertices.resize(in.count(vertex_count, kVertexSize, "vertices"));
  for (Eigen::Vector3d& vertex : solid.vertices) vertex = in.vector();
  solid.triangles.resize(in.count(triangle_count, kTriangleSize, "triangles"));
  for (Triangle& triangle : solid.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = in.u32();
  }
  solid.face_of.resize(triangle_count);
  for (std::uint32_t& face : solid.face_of) face = in.u32();
  solid.faces.resize(in.count(face_count, kMinFaceSize, "faces"));
  for (Face& face : solid.faces) face = read_face(in);
  solid.edges.resize(in.count(edge_count, kEdgeSize, "edges"));
  for (Edge& edge : solid.edges) edge = read_edge(in);

  if (in.rest() != 0) in.fail("it has " + std::to_string(in.rest()) + " bytes after its end");
  // A matching checksum proves nothing about who wrote the values.
  if (solid.solid_count > face_count) in.fail("it has more solids than faces");
  if (const auto bad = find_bad_value(solid)) in.fail(*bad);
  return solid;
}

}  // namespace dowel
