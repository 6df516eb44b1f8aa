#include "dowel/collision/verdict.h"

namespace dowel {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::Clear:
      return "clear";
    case Verdict::Contact:
      return "contact";
    case Verdict::Interference:
      return "interference";
  }
  return "unknown";
}

std::string_view to_string(Method method) {
  switch (method) {
    case Method::Boxes:
      return "boxes";
    case Method::Facets:
      return "facets";
    case Method::Exact:
      return "exact";
  }
  return "unknown";
}

std::string_view to_string(Skip skip) {
  switch (skip) {
    case Skip::Way:
      return "way";
    case Skip::Layers:
      return "layers";
    case Skip::Silhouettes:
      return "silhouettes";
    case Skip::Planes:
      return "planes";
    case Skip::Memory:
      return "memory";
    case Skip::ShallowBoxes:
      return "shallow boxes";
    case Skip::Fits:
      return "fits";
    case Skip::Cores:
      return "cores";
    case Skip::Seats:
      return "seats";
    case Skip::KeptOff:
      return "kept off";
  }
  return "unknown";
}

}  // namespace dowel
