// The output of `springproof --version`.
#pragma once

#include <string>

namespace springproof {

/// "springproof 0.1.0", the libraries that it is built with, and a line for each program beside it with the libraries
/// of that one.
std::string versions();

}  // namespace springproof
