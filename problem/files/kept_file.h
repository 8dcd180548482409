// Results kept between runs in a folder of bounded size.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace springproof {

/// What a kept file is.
struct KeptKind {
  std::string name;     ///< begins the file's name, and is said to users: "mesh"
  std::string ending;   ///< of the file's name: ".cbor"
  std::string heading;  ///< of the file (new_file.h)
};

/// A place for one result among others of its kind in a folder.  All of it is optional: what cannot be read is no
/// result, what cannot be written is lost.  Thread-safe, also among processes.
class KeptFile {
 public:
  KeptFile() = default;  ///< no place
  /// @param folder of the files; empty: no place
  /// @param kind of the result
  /// @param key all that the result follows from; it begins the content
  KeptFile(const std::filesystem::path& folder, KeptKind kind, std::string key);

  /// The result.
  /// @param read makes it of the content, or throws std::runtime_error
  /// @return nothing: it was never kept, or is damaged, which is said on stderr
  template <class Read>
  auto find(const Read& read) const -> std::optional<decltype(read(std::string()))> {
    try {
      if (const std::optional<std::string> kept = content()) return read(*kept);
    } catch (const std::runtime_error&) {
      say_damaged();
    }
    return {};
  }

  /// @param content of the result.  Those of the kind not used for longest go when there are more than 1 GB of them;
  ///   files of others in the folder are neither counted nor removed.
  void keep(const std::string& content) const;

 private:
  std::optional<std::string> content() const;
  void say_damaged() const;

  KeptKind kind_;
  std::string key_;
  std::filesystem::path file_;  ///< empty: no place
};

}  // namespace springproof
