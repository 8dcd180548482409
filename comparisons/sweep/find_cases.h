// Finds case files by path or built-in name, and restricts what of them is compared.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "problem/case_file/experiment.h"

namespace springproof {

/// Case files named by paths: files, folders (the *.toml directly in them), or folders of the built-in experiments
/// ("golec_2019", "golec_2019/compression").
/// @throws InputError if there is no case of a name.
std::vector<std::filesystem::path> find_cases(const std::vector<std::string>& names);

/// The one case of a name.
/// @throws InputError if there is none, or a folder of several.
std::filesystem::path find_case(const std::string& name);

/// "golec_2019/compression" for a built-in case, the file's stem for others.
std::string case_name(const std::filesystem::path& file);

/// All built-in case files.
std::vector<std::filesystem::path> built_in_cases();

/// Restricts a case to the requested settings, and to the expectations at these or at every one; none
/// requested: all of it.
/// @throws InputError if it has none of them.
Experiment only(const std::vector<double>& wanted, Experiment experiment);

/// Multiplies the cells of the reference's grids along each direction, except in directions of one cell.
/// @throws InputError if the case leaves the choice of its reference grids to the program.
Experiment finer(int times, Experiment experiment);

}  // namespace springproof
