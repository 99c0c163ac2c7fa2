#include "srm/grammar/jsgf_output.h"

#include <gtest/gtest.h>

namespace {

TEST(JsgfOutputTest, SeveralGrammarsAreAlternativesOfOne) {
  auto yes = ear::ParseGrammar("yes [please] {Y}");
  auto no = ear::ParseGrammar("no<1-2>");
  EXPECT_EQ(srm::ToJsgf({&*yes, &*no}),
            "#JSGF V1.0;\ngrammar all;\npublic <all> = <g0_0> | <g1_0> ;\n"
            "<g0_0> = ( /1/ ( yes ( [ ( please ) ] ) ) ) ;\n"
            "<g1_0> = ( /1/ ( ( no [ no ] ) ) ) ;\n");
}

}  // namespace
