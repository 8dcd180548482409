// Other programs run from here, which can neither hang their caller nor take it down.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "problem/system/files.h"
#include "problem/system/input_error.h"

namespace springproof {

/// The folder for temporary files ($TMPDIR) is not there, full or closed: nothing that a case could help.
class NoRoom : public InputError {
 public:
  using InputError::InputError;
};

/// A folder of our own in $TMPDIR (/tmp), removed with what is in it at the end of the scope.
class TemporaryFolder {
 public:
  /// @throws NoRoom
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// For when something failed that writes there.
  /// @throws NoRoom if nothing can be written.
  void require_room() const;

  std::filesystem::path path;

 private:
  int lock_ = -1;  ///< of the folder, held by this process alone
};

/// Removes the temporary folders of programs that were killed; the first TemporaryFolder of a process does.
void remove_orphans();

/// A program to be run.  Empty paths: as the caller has it.
struct Child {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;          ///< to run in
  std::filesystem::path output, errors;  ///< files for standard output and standard error; may be the same
  double time_limit = 0;                 ///< wall time [s]; 0: none
  bool group = false;                    ///< the limit ends also what it started itself (a process group of its own)
};

/// How it ended.
struct ChildEnd {
  enum Kind { exited, killed, out_of_time } kind = exited;
  int status = 0;      ///< exit status or signal
  double seconds = 0;  ///< CPU time

  bool ok() const { return kind == exited && status == 0; }
};

/// Exit status of a program that could not be started.
inline constexpr int not_started = 127;

/// Runs it to its end, at most for its time limit; it does not outlive the thread that waits for it.
/// @throws std::runtime_error if it cannot be started.
ChildEnd run_child(const Child& child);

/// Ends every program under way (SIGTERM); may be called in a signal handler.
void interrupt_children();

/// True once that has been called.
bool children_interrupted();

/// "was killed by signal 11 (Segmentation fault)", "failed with status 1", "took longer than 120 s and was ended".
std::string words_for(const ChildEnd& end, double time_limit = 0);

/// The program named by the environment variable, else `name` beside the running executable; empty: there is none.
std::filesystem::path find_program(const std::string& name, const char* variable);

/// The folder of data of an installed program, ../share/springproof/NAME seen from it; else `source`, that of the
/// source tree.
std::filesystem::path data_folder(const std::string& name, const std::filesystem::path& source);

/// The program of that name on PATH; empty: there is none.
std::filesystem::path program_on_path(const std::string& name);

/// What it answers to --version, without white space at the end; empty: it is not there, or does not know.
std::string version_of(const std::filesystem::path& program);

}  // namespace springproof
