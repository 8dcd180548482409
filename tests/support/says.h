// What a message says.
#pragma once

#include <gtest/gtest.h>

#include <string>

/// Whether a message has these words in it.
#define EXPECT_WORDS(message, words) \
  EXPECT_NE(std::string(message).find(words), std::string::npos) << std::string(message)
