// Generates the man page and the bash completion from the command-line parser.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace springproof {

/// springproof.1 in roff, with every command and option that --help shows.
std::string man_page(const CLI::App& app, const std::string& version);

/// Known values of an option ("--model") or of a positional argument ("CASE").
using KnownValues = std::map<std::string, std::vector<std::string>>;

/// A script for bash: commands, their options, known values, else file names.
std::string bash_completion(const CLI::App& app, const KnownValues& values);

}  // namespace springproof
