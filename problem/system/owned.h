// Owners of objects of C libraries.
#pragma once

#include <utility>

namespace springproof {

/// Owns an object that a C function makes and `destroy` takes away by its address, as PETSc's.
template <class Object, auto destroy>
class Owned {
 public:
  Owned() = default;
  Owned(Owned&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Owned() { destroy(&object_); }
  operator Object() const { return object_; }
  Object* operator&() { return &object_; }

 private:
  Object object_ = nullptr;
};

}  // namespace springproof
