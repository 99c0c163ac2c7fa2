// What a person at a terminal reads once and not twice.

#include "agent_manager/session/told_errors.h"

#include <gtest/gtest.h>

#include <string>

namespace am {
namespace {

constexpr const char* kComplaint =
    "FSM ERROR: fsm: error: BAD_VALUE unknown emotion 'MERRY' (in: set FaceExp = MERRY)";

TEST(ToldErrorsTest, WhatTheConsoleWasAnsweredIsKnownOnce) {
  ToldErrors told;
  EXPECT_FALSE(told.Take(kComplaint));
  told.Told("From @FSM rep FaceExp.error = BAD_VALUE unknown emotion 'MERRY'");
  EXPECT_TRUE(told.Take(kComplaint));
  EXPECT_FALSE(told.Take(kComplaint)) << "somebody else's";
}

TEST(ToldErrorsTest, OtherAnswersAndOtherErrorsAreNotTaken) {
  ToldErrors told;
  told.Told("From @FSM rep FaceExp = BAD_VALUE unknown emotion 'MERRY'");
  told.Told("From @FSM rep FaceExp.error = BAD_VALUE unknown emotion 'GLAD'");
  told.Told("no message, error = BAD_VALUE unknown emotion 'MERRY'");
  EXPECT_FALSE(told.Take(kComplaint));
}

TEST(ToldErrorsTest, OnlyLinesAboutALineFromOutsideAreComplaints) {
  EXPECT_TRUE(ToldErrors::IsComplaint(kComplaint));
  EXPECT_FALSE(ToldErrors::IsComplaint("fsm: error: no display"));
  EXPECT_FALSE(ToldErrors::IsComplaint("fsm: reading (in: a folder)"));
}

TEST(ToldErrorsTest, TheOldestAreForgotten) {
  ToldErrors told;
  told.Told("From @FSM rep FaceExp.error = BAD_VALUE unknown emotion 'MERRY'");
  for (std::size_t i = 0; i < ToldErrors::kMost; ++i)
    told.Told("rep X.error = BAD_VALUE " + std::to_string(i));
  EXPECT_FALSE(told.Take(kComplaint));
}

}  // namespace
}  // namespace am
