// Runs other programs as child processes that can neither hang their caller (time limit) nor take it down.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof {

/// The folder for temporary files ($TMPDIR) is missing, full or not writable; not an error of the case.
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

  /// To be called after a failure of something that writes there.
  /// @throws NoRoom if nothing can be written.
  void require_room() const;

  std::filesystem::path path;

 private:
  int lock_ = -1;  ///< of the folder, held by this process alone
};

/// Removes the temporary folders of programs that were killed; called by the first TemporaryFolder of a process.
void remove_orphans();

/// A program to be run.  Empty paths: inherited from the caller.
struct Child {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;          ///< to run in
  std::filesystem::path output, errors;  ///< files for standard output and standard error; may be the same
  double time_limit = 0;                 ///< wall time [s]; 0: none
  bool group = false;                    ///< runs in a process group of its own, and the limit ends the whole group
};

/// How a child process ended.
struct ChildEnd {
  enum Kind { exited, killed, out_of_time } kind = exited;
  int status = 0;      ///< exit status or signal
  double seconds = 0;  ///< CPU time

  bool ok() const { return kind == exited && status == 0; }
};

/// Exit status of a program that could not be started.
inline constexpr int not_started = 127;

/// Runs the program to its end, at most for its time limit; it does not outlive the calling thread.
/// @throws std::runtime_error if it cannot be started.
ChildEnd run_child(const Child& child);

/// Returns what `work` returned, called in a child process.  interrupt_children() ends it.
/// @throws std::runtime_error with the message of the exception thrown by the work, or with how the process ended
/// (memory, signal).
std::string in_child(const std::function<std::string()>& work);

/// Sends SIGTERM to every running child; may be called in a signal handler.
void interrupt_children();

/// True once interrupt_children() has been called.
bool children_interrupted();

/// "was killed by signal 11 (Segmentation fault)", "failed with status 1", "took longer than 120 s and was ended".
std::string words_for(const ChildEnd& end, double time_limit = 0);

/// The program named by the environment variable, else `name` beside the running executable; empty: there is none.
std::filesystem::path find_program(const std::string& name, const char* variable);

/// The data folder of an installed program, ../share/springproof/NAME relative to the executable's folder; otherwise
/// `source`, that of the source tree.
std::filesystem::path data_folder(const std::string& name, const std::filesystem::path& source);

/// For what can be made again: $XDG_CACHE_HOME/springproof or ~/.cache/springproof; empty: there is no home.
std::filesystem::path cache_folder();

/// The program of that name on PATH; empty: there is none.
std::filesystem::path program_on_path(const std::string& name);

/// The output of --version, without trailing white space; empty: the program is missing, or the call fails.
std::string version_of(const std::filesystem::path& program);

}  // namespace springproof
