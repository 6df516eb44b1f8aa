#include "fcl_checker.h"

namespace dowel::bench {

std::unique_ptr<Checker> make_fcl_obbrss() {
  return std::make_unique<FclChecker<fcl::OBBRSS<double>>>();
}

std::unique_ptr<Checker> make_fcl_obb() {
  return std::make_unique<FclChecker<fcl::OBB<double>>>();
}

std::unique_ptr<Checker> make_fcl_obbrss_float() {
  return std::make_unique<FclChecker<fcl::OBBRSS<float>>>();
}

std::unique_ptr<Checker> make_fcl_obb_float() {
  return std::make_unique<FclChecker<fcl::OBB<float>>>();
}

}  // namespace dowel::bench
