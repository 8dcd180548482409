// Edits of valid case files and what the reader must say against them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/case_file.h"

namespace springproof::test {

/// One edit of a valid case and what must be in the message.
struct Mistake {
  const char* name;
  const char* file;
  const char* replace;  ///< "" appends
  const char* with;
  std::vector<const char*> says;
};

inline void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

inline void expect_explained(const Mistake& mistake) {
  std::string text = mistake.file;
  ASSERT_NE(message_of(text).find("accepted"), std::string::npos) << "the unedited file must be valid";
  const std::string old = mistake.replace;
  const std::size_t at = text.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  old.empty() ? text.append(mistake.with) : text.replace(at, old.size(), mistake.with);
  const std::string message = message_of(text);
  EXPECT_EQ(message.rfind("case.toml:", 0), 0u) << message;
  for (const char* part : mistake.says)
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
}

}  // namespace springproof::test
