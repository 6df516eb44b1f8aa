#include "fcl_checker.h"

namespace dowel::bench {

std::unique_ptr<Checker> make_fcl_obbrss() {
  return std::make_unique<FclChecker<fcl::OBBRSS<double>>>();
}

}  // namespace dowel::bench
