// The part of std::experimental::simd that the kernels use, on the compiler's own vectors of SPRINGPROOF_VECTOR_BYTES:
// for WebAssembly, whose standard library has vectors without roots, and for vectors wider than the processor's, which
// the compiler makes of several.  Included by simd.h, within its namespace.

/// Comparison of vectors, all bits of a lane or none.
template <class Int>
struct Mask {
  Int bits;
};

template <class Real>
class Simd {
 public:
  using Vector = typename Builtin<Real, SPRINGPROOF_VECTOR_BYTES / sizeof(Real)>::type;
  using Int = decltype(Vector() < Vector());

  Simd() = default;
  Simd(Real value) : v_(Vector{} + value) {}
  explicit Simd(Vector v) : v_(v) {}
  template <class Flag>
  Simd(const Real* p, Flag) {
    __builtin_memcpy(&v_, p, sizeof v_);
  }
  template <class Flag>
  void copy_to(Real* p, Flag) const {
    __builtin_memcpy(p, &v_, sizeof v_);
  }
  static constexpr unsigned long size() { return SPRINGPROOF_VECTOR_BYTES / sizeof(Real); }
  explicit operator Vector() const { return v_; }

  friend Simd operator+(Simd a, Simd b) { return Simd(a.v_ + b.v_); }
  friend Simd operator-(Simd a, Simd b) { return Simd(a.v_ - b.v_); }
  friend Simd operator*(Simd a, Simd b) { return Simd(a.v_ * b.v_); }
  friend Simd operator/(Simd a, Simd b) { return Simd(a.v_ / b.v_); }
  friend Simd operator-(Simd a) { return Simd(-a.v_); }
  Simd& operator+=(Simd b) { return *this = *this + b; }
  Simd& operator-=(Simd b) { return *this = *this - b; }
  Simd& operator*=(Simd b) { return *this = *this * b; }
  friend Mask<Int> operator<(Simd a, Simd b) { return {a.v_ < b.v_}; }
  friend Mask<Int> operator==(Simd a, Simd b) { return {a.v_ == b.v_}; }

 private:
  Vector v_;
};

template <class Real>
inline Simd<Real> sqrt(Simd<Real> a) {
  auto v = static_cast<typename Simd<Real>::Vector>(a);
#ifdef __wasm__
  if constexpr (sizeof(Real) == 8)
    return Simd<Real>(__builtin_wasm_sqrt_f64x2(v));
  else
    return Simd<Real>(__builtin_wasm_sqrt_f32x4(v));
#else
  for (unsigned long i = 0; i < a.size(); ++i) v[i] = static_cast<Real>(__builtin_sqrt(v[i]));
  return Simd<Real>(v);
#endif
}
template <class Real>
inline Simd<Real> abs(Simd<Real> a) {
  const auto v = static_cast<typename Simd<Real>::Vector>(a);
  return Simd<Real>(v < 0 ? -v : v);
}

/// The lanes that a mask selects, to be assigned to.
template <class Real>
struct Where {
  Mask<typename Simd<Real>::Int> mask;
  Simd<Real>& v;
  void operator=(const Simd<Real>& value) const {
    using Vector = typename Simd<Real>::Vector;
    v = Simd<Real>(mask.bits ? static_cast<Vector>(value) : static_cast<Vector>(v));
  }
};
template <class Real>
inline Where<Real> where(Mask<typename Simd<Real>::Int> mask, Simd<Real>& v) {
  return {mask, v};
}

template <class Int>
inline bool any_of(Mask<Int> mask) {
  for (unsigned long i = 0; i < sizeof(Int) / sizeof mask.bits[0]; ++i)
    if (mask.bits[i]) return true;
  return false;
}
template <class Int>
inline bool all_of(Mask<Int> mask) {
  return !any_of(Mask<Int>{~mask.bits});
}

struct ElementAligned {};
inline constexpr ElementAligned element_aligned;
template <class Real>
using native_simd = Simd<Real>;
