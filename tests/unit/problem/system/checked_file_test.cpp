// Files that say themselves whether they are whole.
#include "problem/files/new_file.h"

#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <thread>
#include <vector>

#include "problem/processes/child.h"

namespace springproof::checked_file_test {
namespace {

namespace fs = std::filesystem;

/// Removed first if it is there.
int created_by_how_many(const fs::path& file) {
  fs::remove(file);
  std::atomic<int> created = 0;
  std::vector<std::thread> writers;
  for (int i = 0; i < 8; ++i)
    writers.emplace_back(
        [&, i] { created += create_checked(file, "test 1 ", std::string(100000, static_cast<char>('a' + i))); });
  for (std::thread& w : writers) w.join();
  EXPECT_EQ(read_checked(file, "test 1 ").size(), 100000u);
  return created;
}

TEST(CheckedFile, IsCreatedByOneAndWrittenWholeByAny) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path / "here");
  const fs::path file = folder.path / "here" / "file";
  EXPECT_EQ(created_by_how_many(file), 1);
  std::vector<std::thread> writers;
  for (int i = 0; i < 8; ++i)
    writers.emplace_back([&, i] {
      for (int k = 0; k < 20; ++k) {
        write_checked(file, "test 1 ", std::string(100000, static_cast<char>('a' + i)));
        EXPECT_NO_THROW(read_checked(file, "test 1 "));
      }
    });
  for (std::thread& w : writers) w.join();
  EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), {}), 1) << "something is left behind";
  EXPECT_THROW(read_checked(file, "other 1 "), DamagedFile);
  EXPECT_THROW(write_checked(folder.path / "missing" / "file", "test 1 ", "1"), std::runtime_error);
}

TEST(CheckedFile, OfWhichAnyBitIsChangedIsDamaged) {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "file";
  write_checked(file, "test 1 ", "content");
  const std::string whole = text_of_file(file);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string bytes = whole;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    write_file(file, bytes);
    EXPECT_THROW(read_checked(file, "test 1 "), DamagedFile) << bit;
  }
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_file(file, whole.substr(0, size));
    EXPECT_THROW(read_checked(file, "test 1 "), DamagedFile) << size;
  }
  write_file(file, whole);
  EXPECT_EQ(read_checked(file, "test 1 "), "content");
}

/// From now on these system calls of the process fail with `error`, as on a file system that has none.
bool without(std::initializer_list<long> calls, int error) {
  std::vector<sock_filter> filter = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  for (const long call : calls) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<__u32>(call), 0, 1));
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<__u32>(error)));
  }
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

TEST(CheckedFile, IsCreatedByOneAlsoWithoutHardLinks) {
  const TemporaryFolder folder;
  constexpr int no_filter = 77, tries = 20;
  const std::initializer_list<long> links = {SYS_link, SYS_linkat}, all = {SYS_link, SYS_linkat, SYS_renameat2};
  for (const auto& [missing, error] : {std::pair(links, EPERM), {all, EINVAL}}) {
    const pid_t child = fork();
    if (child == 0) {
      if (!without(missing, error) || link("/etc/passwd", (folder.path / "link").c_str()) == 0) _exit(no_filter);
      bool one = true;
      for (int i = 0; i < tries; ++i) one = one && created_by_how_many(folder.path / "file") == 1;
      _exit(one && !testing::Test::HasFailure() ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == no_filter) GTEST_SKIP() << "no filter of system calls here";
    EXPECT_EQ(status, 0);
  }
}

}  // namespace
}  // namespace springproof::checked_file_test
