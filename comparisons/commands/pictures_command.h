// The subcommand that writes the report's figures as PNG files.
#pragma once

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace springproof {

/// `springproof pictures FOLDER`.
class PicturesCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0: every picture was written; 1: one was not.
  /// @throws InputError if there is no report in the folder, or no Chromium.
  int run() const;

 private:
  std::filesystem::path folder_ = "springproof-report";
  std::string only_;
  double time_limit_ = 600;
};

}  // namespace springproof
