// Serialisation of types of other libraries to JSON and CBOR: optional values, variants, vectors and matrices.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace nlohmann {

/// null, or the value.
template <class T>
struct adl_serializer<std::optional<T>> {
  static void to_json(json& j, const std::optional<T>& value) { value ? j = *value : j = nullptr; }
  static void from_json(const json& j, std::optional<T>& value) {
    value = j.is_null() ? std::optional<T>() : std::optional<T>(j.get<T>());
  }
};

/// [number of the alternative, its value]; an alternative needs a default constructor.
template <class... T>
struct adl_serializer<std::variant<T...>> {
  static void to_json(json& j, const std::variant<T...>& value) {
    std::visit([&](const auto& alternative) { j = {value.index(), alternative}; }, value);
  }
  static void from_json(const json& j, std::variant<T...>& value) {
    const std::size_t wanted = j.at(0).get<std::size_t>();
    std::size_t index = 0;
    const auto read = [&]<class Alternative>(Alternative alternative) {
      if (index++ == wanted) j.at(1).get_to(alternative), value = std::move(alternative);
    };
    (read(T{}), ...);
    if (wanted >= index) throw std::runtime_error("an alternative that there is not");
  }
};

/// The entries in storage order; the number of rows follows from their count.
template <int rows, int columns, int options>
struct adl_serializer<Eigen::Matrix<double, rows, columns, options>> {
  using Matrix = Eigen::Matrix<double, rows, columns, options>;
  static_assert(columns > 0);

  static void to_json(json& j, const Matrix& matrix) {
    j = std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  }
  static void from_json(const json& j, Matrix& matrix) {
    const auto numbers = j.get<std::vector<double>>();
    const auto size = static_cast<Eigen::Index>(numbers.size());
    if (size % columns != 0 || (rows > 0 && size != rows * columns))
      throw std::runtime_error("a matrix with too few numbers");
    matrix = Eigen::Map<const Matrix>(numbers.data(), size / columns, columns);
  }
};

}  // namespace nlohmann

namespace springproof {

/// The document in CBOR.
inline std::string cbor(const nlohmann::json& document) {
  std::string bytes;
  nlohmann::json::to_cbor(document, bytes);
  return bytes;
}

}  // namespace springproof
