#include "comparisons/report/png_page.h"

#include <gtest/gtest.h>

#include <fstream>

namespace springproof::png_page_test {
namespace {

TEST(PngPage, PicturesAndFailuresAreReadFromThePage) {
  const PngPage page = png_page(
      "<body><pre class=\"png\" data-name=\"a-nu0.4.png\">iVBORw0KGgr/AA==</pre>"
      "<p class=\"png-failed\">b: nothing was drawn</p><p class=\"png-done\">2</p></body>");
  ASSERT_EQ(page.files.size(), 1u);
  EXPECT_EQ(page.files[0].name, "a-nu0.4.png");
  EXPECT_EQ(page.files[0].bytes, std::string("\x89PNG\r\n\x1a\n\xff\0", 10));
  EXPECT_EQ(page.failed, std::vector<std::string>{"b: nothing was drawn"});
}

TEST(PngPage, WhatIsNoPictureIsRefused) {
  EXPECT_THROW(png_page("<body></body>"), std::runtime_error) << "the scripts did not end";
  EXPECT_THROW(png_page("<pre class=\"png\" data-name=\"a.png\">AAAA</pre><p class=\"png-done\">1</p>"),
               std::runtime_error);
  EXPECT_THROW(png_page("<pre class=\"png\" data-name=\"../a.png\">iVBORw0KGgo=</pre><p class=\"png-done\">1</p>"),
               std::runtime_error);
}

TEST(DumpDom, AProgramThatHangsIsEnded) {
  const auto file = std::filesystem::path(testing::TempDir()) / "springproof_hangs";
  std::ofstream(file) << "#!/bin/sh\nsleep 60\n";
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  try {
    dump_dom(file, "page.html", "#png=0", 0.3);
    FAIL() << "it was waited for";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("not finished after 0.3 s"), std::string::npos) << e.what();
  }
  std::ofstream(file) << "#!/bin/sh\nexit 3\n";
  EXPECT_THROW(dump_dom(file, "page.html", "#png=0", 10), std::runtime_error);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace springproof::png_page_test
