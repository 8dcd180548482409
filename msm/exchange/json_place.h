// A value of a JSON document with its place, for errors that name it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace springproof {

inline constexpr double largest_number_of_file = 1e30;  ///< products of a few numbers of a file do not overflow
inline constexpr double smallest_of_file = 1e-30, farthest_node = 1e9;  ///< [m]

class JsonPlace {
 public:
  /// `value` and `file` must outlive it.
  JsonPlace(const nlohmann::json& value, std::string pointer, const std::string& file)
      : value_(&value), pointer_(std::move(pointer)), file_(&file) {}

  /// @throws InputError "FILE: /pointer: WHAT (allowed: ALLOWED)".
  [[noreturn]] void refuse(const std::string& what, const std::string& allowed) const;

  JsonPlace at(const std::string& key) const;  ///< a required key of an object
  std::optional<JsonPlace> find(const std::string& key) const;
  std::vector<std::string> keys() const;
  std::vector<JsonPlace> items() const;  ///< of a list
  /// @throws InputError at the first key that is not among `known`.
  void require_known(const std::vector<std::string>& known) const;

  bool empty() const;
  bool is_list() const;
  bool first_is_list() const;  ///< of a list that is not empty

  double number(double least, double largest) const;  ///< ends included
  bool flag() const;
  std::string text() const;
  int choice(std::span<const char* const> names) const;  ///< number of the name

  /// A list of rows of `columns` numbers each, row by row; of plain numbers if columns = 1.  `rows`: how many there
  /// must be, of what (`of`); no `of`: any number of them.
  std::vector<double> numbers(int columns, std::size_t rows = 0, const char* of = nullptr,
                              double least = -largest_number_of_file, double largest = largest_number_of_file) const;
  /// The same of whole numbers from 0 to `largest`.
  std::vector<int> integers(int columns, int largest, std::size_t rows = 0, const char* of = nullptr) const;

 private:
  template <class Read>
  void for_each_number(int columns, std::size_t rows, const char* of, const Read& read) const;

  const nlohmann::json* value_;
  std::string pointer_;
  const std::string* file_;
};

}  // namespace springproof
