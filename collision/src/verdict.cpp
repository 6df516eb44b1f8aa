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

}  // namespace dowel
