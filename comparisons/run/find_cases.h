// Where case files lie and what they are called.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace springproof {

/// Case files named by paths: files, folders (the *.toml right in them), or folders of the built-in experiments
/// ("golec_2019", "golec_2019/compression").
/// @throws InputError if a name leads nowhere.
std::vector<std::filesystem::path> find_cases(const std::vector<std::string>& names);

/// "golec_2019/compression" for a built-in case, the file's stem for others.
std::string case_name(const std::filesystem::path& file);

/// All built-in case files.
std::vector<std::filesystem::path> built_in_cases();

}  // namespace springproof
