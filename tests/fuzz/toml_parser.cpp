// toml++'s parser, compiled here and not taken from its library, so that the fuzzer sees its branches.
#undef TOML_SHARED_LIB
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
