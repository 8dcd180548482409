#include "comparisons/png_page.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace springproof {
namespace {

namespace fs = std::filesystem;

std::string from_base64(const std::string& text) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static const std::array<int, 256> values = [] {
    std::array<int, 256> v;
    v.fill(-1);
    for (std::size_t i = 0; i < digits.size(); ++i) v[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    return v;
  }();
  std::string out;
  unsigned group = 0;
  int bits = 0;
  for (const unsigned char c : text) {
    if (values[c] < 0) break;
    group = (group << 6 | static_cast<unsigned>(values[c])) & 0xffffff;
    if ((bits += 6) < 8) continue;
    bits -= 8;
    out += static_cast<char>(group >> bits & 0xff);
  }
  return out;
}

/// Every text between `open` and `close`.
std::vector<std::string> all_between(const std::string& text, const std::string& open, const std::string& close) {
  std::vector<std::string> found;
  for (std::size_t at = 0; (at = text.find(open, at)) != std::string::npos;) {
    at += open.size();
    const std::size_t end = text.find(close, at);
    if (end == std::string::npos) break;
    found.push_back(text.substr(at, end - at));
    at = end;
  }
  return found;
}

/// file:// address of a path.
std::string url_of(const fs::path& path) {
  std::string out = "file://";
  for (const unsigned char c : fs::absolute(path).string())
    out += std::isalnum(c) || std::strchr("/-_.~", c) ? std::string(1, static_cast<char>(c)) : fmt::format("%{:02X}", c);
  return out;
}

class ProfileFolder {
 public:
  ProfileFolder() {
    std::string name = (fs::temp_directory_path() / "springproof-png-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error(fmt::format("cannot make {}: {}", name, std::strerror(errno)));
    path = name;
  }
  ~ProfileFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  ProfileFolder(const ProfileFolder&) = delete;
  ProfileFolder& operator=(const ProfileFolder&) = delete;

  fs::path path;
};

/// Starts a program as the leader of its own process group, with its output in a file.
pid_t start(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& output) {
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(fmt::format("cannot start {}: {}", program.string(), std::strerror(errno)));
  if (child > 0) return child;
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), none = open("/dev/null", O_RDWR);
  dup2(none, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(none, STDERR_FILENO);
  execv(program.c_str(), argv.data());
  _exit(127);
}

/// Exit status of a child; -1: it was still running after `time_limit` seconds, and was ended with its own children.
int wait_for(pid_t child, double time_limit) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  bool in_time = true;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (in_time && std::chrono::duration<double>(Clock::now() - begin).count() > time_limit) {
      in_time = false;
      kill(-child, SIGKILL);
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return in_time ? status : -1;
}

}  // namespace

PngPage png_page(const std::string& dom) {
  const std::vector<std::string> done = all_between(dom, "<p class=\"png-done\">", "</p>");
  if (done.empty()) throw std::runtime_error("the browser did not come to the end of the page");
  PngPage page;
  for (const std::string& item : all_between(dom, "<pre class=\"png\" data-name=\"", "</pre>")) {
    const std::size_t quote = item.find('"'), text = item.find('>');
    page.files.push_back({item.substr(0, quote), from_base64(item.substr(text + 1))});
    if (page.files.back().name.find('/') != std::string::npos || !page.files.back().bytes.starts_with("\x89PNG"))
      throw std::runtime_error("the browser gave something that is no PNG");
  }
  page.failed = all_between(dom, "<p class=\"png-failed\">", "</p>");
  return page;
}

fs::path find_chromium() {
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (const fs::path file = fs::path(folder) / name; access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

std::string dump_dom(const fs::path& chromium, const fs::path& page, const std::string& fragment, double time_limit) {
  const ProfileFolder folder;
  const fs::path output = folder.path / "dom.html";
  const int status = wait_for(start(chromium,
                                    {"--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                                     "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
                                     "--disable-background-networking", "--disable-component-update", "--disable-sync",
                                     "--user-data-dir=" + (folder.path / "profile").string(), "--dump-dom",
                                     url_of(page) + fragment},
                                    output),
                              time_limit);
  if (status < 0) throw std::runtime_error(fmt::format("not finished after {:g} s; allow more with --time-limit", time_limit));
  if (status != 0) throw std::runtime_error(fmt::format("{} failed (status {})", chromium.string(), status));
  std::ifstream in(output, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace springproof
