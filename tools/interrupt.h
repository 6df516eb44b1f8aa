#pragma once

#include <csignal>

namespace dowel::tools {

/// While it lives, Ctrl-C (SIGINT) and SIGTERM do not end the program but are noted, once: a second
/// one ends it as ever. One at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// The signal that came; 0: none did.
  int signal() const;

 private:
  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
};

}  // namespace dowel::tools
