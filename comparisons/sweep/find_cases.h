// Finds case files by path or built-in name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace springproof {

/// Case files named by paths: files, folders (the *.toml directly in them), or folders of the built-in experiments
/// ("golec_2019", "golec_2019/compression").
/// @throws InputError if there is no case of a name.
std::vector<std::filesystem::path> find_cases(const std::vector<std::string>& names);

/// "golec_2019/compression" for a built-in case, the file's stem for others.
std::string case_name(const std::filesystem::path& file);

/// All built-in case files.
std::vector<std::filesystem::path> built_in_cases();

}  // namespace springproof
