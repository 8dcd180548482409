#include "problem/system/streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>

#include "problem/system/input_error.h"
#include "problem/system/shortened.h"

namespace springproof {
namespace {

std::atomic<int> stdout_error = 0;  // the first, of errno

void write_to(std::FILE* stream, std::string_view text) noexcept { std::fwrite(text.data(), 1, text.size(), stream); }

/// A stream that the caller closed would be the next file that is opened, and what is said would be written into that.
/// Opened the wrong way round, every use of it still fails.
void open_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

int status_of(const std::function<int()>& program) try { return program(); } catch (const InputError& e) {
  to_stderr("error: {}\n", e.what());
  return 2;
} catch (const std::filesystem::filesystem_error& e) {
  to_stderr("error: {}: {}\n", shortened(e.path1().string()), e.code().message());
  return 2;
} catch (const std::exception& e) {
  to_stderr("error: {}\n", e.what());
  return 1;
}

}  // namespace

void write_to_stdout(std::string_view text) noexcept {
  errno = 0;
  write_to(stdout, text);
  if (int none = 0; std::ferror(stdout)) stdout_error.compare_exchange_strong(none, errno);
}

void write_to_stderr(std::string_view text) noexcept { write_to(stderr, text); }

int run_as_program(const std::function<int()>& program) {
  open_streams();
  std::signal(SIGPIPE, SIG_IGN);  // a reader that has ended ends no run
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is an error of writing; children inherit it
  const int status = status_of(program);
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
  const int error = stdout_error ? stdout_error.load() : errno;
  if (error == EPIPE) {  // as `springproof list | head` ends everywhere
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  to_stderr("error: standard output cannot be written: {}\n", std::strerror(error ? error : EIO));
  return status == 0 ? 1 : status;
}

}  // namespace springproof
