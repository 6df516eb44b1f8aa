#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace dowel {

/// An exact sum of at most `kCapacity` doubles that do not overlap, from the smallest magnitude to
/// the largest, without zeros: its sign is that of the last term. Exact as long as nothing
/// overflows or underflows.
/// Source: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates", 1997. Departs: sums grow term by term, and products use a fused multiply-add.
template <std::size_t kCapacity>
class Expansion {
 public:
  Expansion() = default;

  /// a - b.
  static Expansion difference(double a, double b) {
    static_assert(kCapacity >= 2);
    Expansion result;
    result.add(a);
    result.add(-b);
    return result;
  }

  std::size_t size() const noexcept { return size_; }
  double operator[](std::size_t i) const noexcept { return terms_[i]; }
  int sign() const noexcept {
    if (size_ == 0) return 0;
    return terms_[size_ - 1] > 0.0 ? 1 : -1;
  }

  /// Adds one number. Expects: room for one more term.
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = value + terms_[i];
      const double part = sum - value;
      const double rest = (value - (sum - part)) + (terms_[i] - part);
      if (rest != 0.0) terms_[kept++] = rest;
      value = sum;
    }
    if (value != 0.0) terms_[kept++] = value;
    size_ = kept;
  }

  /// Adds the product of two numbers. Expects: room for two more terms.
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }

 private:
  std::array<double, kCapacity> terms_{};
  std::size_t size_ = 0;
};

/// a * b.
template <std::size_t m, std::size_t n>
Expansion<2 * m * n> operator*(const Expansion<m>& a, const Expansion<n>& b) {
  Expansion<2 * m * n> result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result.add_product(a[i], b[j]);
  }
  return result;
}

template <std::size_t m, std::size_t n>
Expansion<m + n> operator+(const Expansion<m>& a, const Expansion<n>& b) {
  Expansion<m + n> result;
  for (std::size_t i = 0; i < a.size(); ++i) result.add(a[i]);
  for (std::size_t j = 0; j < b.size(); ++j) result.add(b[j]);
  return result;
}

template <std::size_t m, std::size_t n>
Expansion<m + n> operator-(const Expansion<m>& a, const Expansion<n>& b) {
  Expansion<m + n> result;
  for (std::size_t i = 0; i < a.size(); ++i) result.add(a[i]);
  for (std::size_t j = 0; j < b.size(); ++j) result.add(-b[j]);
  return result;
}

}  // namespace dowel
