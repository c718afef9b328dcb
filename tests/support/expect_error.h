// EXPECT_ERROR(statement, "part", ...): the statement throws waretwin::Error with one line that holds every part.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "core/error.h"

namespace waretwin::test {

template <class Statement>
::testing::AssertionResult throws_error(Statement&& statement, std::initializer_list<std::string> parts) {
  try {
    statement();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.find('\n') != std::string::npos) return ::testing::AssertionFailure() << "more than one line: " << message;
    for (const std::string& part : parts) {
      if (message.find(part) == std::string::npos) return ::testing::AssertionFailure() << "'" << part << "' is not in: " << message;
    }
    return ::testing::AssertionSuccess();
  } catch (const std::exception& other) {
    return ::testing::AssertionFailure() << "another exception: " << other.what();
  }
  return ::testing::AssertionFailure() << "nothing was thrown";
}

}  // namespace waretwin::test

#define EXPECT_ERROR(statement, ...) EXPECT_TRUE(::waretwin::test::throws_error([&] { statement; }, {__VA_ARGS__}))
