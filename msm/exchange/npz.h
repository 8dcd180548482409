// NumPy's archive of arrays, .npz: a zip file of .npy files.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "msm/exchange/springs_document.h"

namespace springproof {

/// An array as a .npy file, version 1.0.
std::string npy(const NamedArray& array);

/// A zip file of the named contents, not compressed.
/// @throws std::invalid_argument beyond 4 GB, or 65,535 files.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace springproof
