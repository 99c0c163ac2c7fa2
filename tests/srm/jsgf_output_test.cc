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

std::size_t LongestRow(const std::string& text) {
  const auto grammar = ear::ParseGrammar(text);
  return grammar ? srm::LongestOptionalRow(*grammar) : 0;
}

TEST(LongestOptionalRowTest, PartsThatMayBeLeftOutAreCountedWhereTheyMeet) {
  EXPECT_EQ(LongestRow("yes no"), 0u);
  EXPECT_EQ(LongestRow("[a] [b] {T} [c] d [e]"), 3u);
  EXPECT_EQ(LongestRow("(x [a]) ([b] y)"), 2u);
  EXPECT_EQ(LongestRow("one<0-300>"), 300u);
  EXPECT_EQ(LongestRow("(one<0-30>)<2-30>"), 900u);
  EXPECT_EQ(LongestRow("$o = [a] [b]\n$o $o ($o | c) x"), 6u);
  EXPECT_EQ(LongestRow("$r = x [$r]\n$r"), 1u);
}

}  // namespace
