// "This must be refused, and the message must say where, what and what would be right."
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "sim/base/error.h"

namespace sunfleck::test {

// Expects `action` to throw an Error of `kind` whose where and problem hold the given parts.
inline void expect_refusal(const std::function<void()>& action, ErrorKind kind, const std::string& where,
                           const std::string& problem) {
  try {
    action();
    ADD_FAILURE() << "was accepted; expected a complaint about '" << where << "': '" << problem << "'";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_NE(error.where().find(where), std::string::npos) << "where: " << error.where();
    EXPECT_NE(error.problem().find(problem), std::string::npos) << "problem: " << error.problem();
    EXPECT_FALSE(error.remedy().empty()) << error.what();
  }
}

}  // namespace sunfleck::test
