// Checks that something is refused with a message that says where, what, and what would be right.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

#include "sim/base/error.h"
#include "tests/support/golden.h"

namespace sunfleck::test {

inline std::filesystem::path write_scratch(const std::string& name, std::string_view content) {
  const auto path = scratch_dir() / name;
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

inline void expect_refused(const std::function<void()>& attempt, ErrorKind kind, const std::string& where,
                           const std::string& problem, const std::string& remedy) {
  try {
    attempt();
    FAIL() << "accepted, although: " << problem;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_NE(error.where().find(where), std::string::npos) << error.where() << " lacks " << where;
    EXPECT_NE(error.problem().find(problem), std::string::npos) << error.problem();
    EXPECT_NE(error.remedy().find(remedy), std::string::npos) << error.remedy();
  }
}

}  // namespace sunfleck::test
