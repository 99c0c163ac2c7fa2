#include <gtest/gtest.h>

#include "tests/support/environment.h"

int main(int argc, char** argv) {
  const support::PrivateEnvironment environment;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
