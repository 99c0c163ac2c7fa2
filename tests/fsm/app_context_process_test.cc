// fsm says what draws.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/process.h"

namespace {

using support::Process;

struct Version {
  std::vector<std::string> out;
  std::string err;
};

/// `fsm --version` with more options and variables of the environment before it.
Version VersionOf(std::vector<std::string> environment, std::vector<std::string> options) {
  std::vector<std::string> command{"/usr/bin/env", "-u", "GALATEA_CONTEXT"};
  command.insert(command.end(), environment.begin(), environment.end());
  command.push_back(GALATEA_BIN_DIR "/fsm");
  command.insert(command.end(), options.begin(), options.end());
  Process process(command);
  Version version;
  version.out = process.ReadAll();
  EXPECT_EQ(process.Wait(), 0);
  version.err = process.ErrorText();
  return version;
}

bool Has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(FsmContextTest, VersionNamesTheRendererOnStderr) {
  const Version version = VersionOf({}, {"--version"});
  ASSERT_EQ(version.out.size(), 1U);
  EXPECT_EQ(version.out[0], "fsm (Galatea) " GALATEA_VERSION);
  EXPECT_TRUE(Has(version.err, "fsm: renderer off screen: ")) << version.err;
  EXPECT_TRUE(Has(version.err, "by OSMesa") || Has(version.err, ", software")) << version.err;
}

// Where no EGL driver is installed, as this variable of libglvnd says.
const char* const kNoEgl = "__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null";

TEST(FsmContextTest, WithoutAnyEglItIsToldOrTheNextWayIsTaken) {
  const Version egl = VersionOf({kNoEgl}, {"--context", "egl", "--version"});
  EXPECT_TRUE(Has(egl.err, "renderer off screen: none: ")) << egl.err;
  const Version any = VersionOf({kNoEgl}, {"--version", "--context", "auto"});
  EXPECT_TRUE(Has(any.err, "by OSMesa")) << any.err;
}

TEST(FsmContextTest, TheEnvironmentChoosesWhereNoOptionDoes) {
  const Version chosen = VersionOf({kNoEgl, "GALATEA_CONTEXT=egl"}, {"--version"});
  EXPECT_TRUE(Has(chosen.err, "none: ")) << chosen.err;
  const Version option =
      VersionOf({kNoEgl, "GALATEA_CONTEXT=egl"}, {"--context", "osmesa", "--version"});
  EXPECT_TRUE(Has(option.err, "by OSMesa") || Has(option.err, ", software")) << option.err;
}

}  // namespace
