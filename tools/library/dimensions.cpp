#include "dimensions.h"

#include <algorithm>

#include "dowel/kernel/check.h"

namespace dowel::library {

const FastenerSize& fastener_size(std::string_view thread) {
  const auto found = std::find_if(kFasteners.begin(), kFasteners.end(),
                                  [&](const auto& size) { return size.thread.name == thread; });
  DOWEL_EXPECTS(found != kFasteners.end());
  return *found;
}

}  // namespace dowel::library
