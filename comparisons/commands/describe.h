// The command line as a man page and as completion for bash, from the tables that parse it.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace springproof {

/// springproof.1 in roff, with every command and option that --help shows.
std::string man_page(const CLI::App& app, const std::string& version);

/// Words for the values of an option ("--model") or for what is given by its place ("CASE"), where they are known.
using KnownValues = std::map<std::string, std::vector<std::string>>;

/// A script for bash: commands, their options, known values, else file names.
std::string bash_completion(const CLI::App& app, const KnownValues& values);

}  // namespace springproof
