#include "msm/kernels/simd.h"
