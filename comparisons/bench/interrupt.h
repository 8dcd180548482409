// Interrupt handling: an interrupted bench shows what it has measured so far.
#pragma once

#include <stdexcept>

namespace springproof::bench {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// From here on SIGINT and SIGTERM end the running child processes and make throw_if_interrupted() throw.
void catch_interrupts();

bool interrupted();

/// @throws Interrupted
void throw_if_interrupted();

}  // namespace springproof::bench
