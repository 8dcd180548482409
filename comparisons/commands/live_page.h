// The page in which bodies can be pulled.
#pragma once

#include <filesystem>

namespace springproof {

/// The built page, which --live copies beside a report.
/// @throws InputError saying how it is built, where it is not.
std::filesystem::path live_page();

}  // namespace springproof
