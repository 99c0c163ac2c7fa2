// Phones by words: triphones, the language model's words, their tree, and the search through it,
// with a model by hand and the installed one.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/vdm/hand_model.h"
#include "vdm/words/word_decoder.h"
#include "vdm/words/word_likelihoods.h"

namespace vdm {
namespace {

constexpr ContextModel::Phone kA = 0, kB = 1, kC = 2, kSil = 3;

/// Phones A, B, C and SIL, and words of them.
class WordsTest : public testing::Test {
 protected:
  WordsTest() { hand.OneContext(kB, kA, kC); }

  vm::Result<std::shared_ptr<const ContextModel>> Contexts() const {
    auto phones = PhoneModel::Read(hand.folder);
    EXPECT_TRUE(phones) << phones.error().text;
    return ContextModel::Read(hand.folder, *phones);
  }
  /// Words and the natural logarithms of their likelihoods, as a quantised trie of order 2.
  void Likelihoods(const std::vector<std::pair<std::string, double>>& words) const {
    std::string text = "Trie Language Model\2";
    text += HandModel::Bytes(static_cast<unsigned>(words.size())) + HandModel::Bytes(0U);
    text += HandModel::Bytes(1U) + std::string(65536 * sizeof(float), '\0');
    std::string names;
    for (const auto& [word, likely] : words) {
      text += HandModel::Bytes(static_cast<float>(likely / std::log(1.0001))) +
              HandModel::Bytes(0.0F) + HandModel::Bytes(0U);
      names += word + '\0';
    }
    text += std::string(12, '\0') + "pairs of words";
    hand.Write("lm", text + HandModel::Bytes(static_cast<unsigned>(names.size())) + names);
  }
  vm::Result<std::shared_ptr<const WordTree>> Tree(const std::string& dictionary) const {
    hand.Write("dict", dictionary);
    return WordTree::Read(File("dict"), File("lm"), *Contexts());
  }
  std::string File(const std::string& name) const { return (hand.folder / name).string(); }
  /// Frames that stand where the first Gaussian of a phone does, so many of each.
  static std::vector<float> Said(const std::vector<std::pair<double, int>>& phones) {
    std::vector<float> frames;
    for (const auto& [phone, count] : phones) {
      for (int i = 0; i < count * static_cast<int>(PhoneModel::kFeatures); ++i) {
        const int stream = i % static_cast<int>(PhoneModel::kFeatures) / 13;
        frames.push_back(static_cast<float>(phone + stream));
      }
    }
    return frames;
  }
  const HandModel hand{{"A", "B", "C", "SIL"}, "vdm_words"};
};

TEST_F(WordsTest, APhoneBetweenItsNeighboursHasStatesOfItsOwn) {
  const auto contexts = Contexts();
  ASSERT_TRUE(contexts) << contexts.error().text;
  const ContextModel& model = **contexts;
  const auto own = model.SequenceOf(kB, kA, kC, ContextModel::Place::kInside);
  EXPECT_EQ(own, 4);
  // At other places that of the inside counts, and between others the phone by itself.
  EXPECT_EQ(model.SequenceOf(kB, kA, kC, ContextModel::Place::kEnd), own);
  EXPECT_EQ(model.SequenceOf(kB, kA, kSil, ContextModel::Place::kInside), kB);
  EXPECT_EQ(model.SequenceOf(kA, kB, kC, ContextModel::Place::kInside), kA);
}

TEST_F(WordsTest, StatesAreAsLikelyAsTheFormulaSays) {
  const auto contexts = Contexts();
  ASSERT_TRUE(contexts) << contexts.error().text;
  ContextScorer scorer(**contexts);
  const auto frames = Said({{1.5, 1}, {0, 1}});
  for (const std::size_t frame : {0U, 1U}) {
    scorer.Begin(&frames[frame * PhoneModel::kFeatures]);
    for (const ContextModel::Sequence sequence :
         {ContextModel::Sequence{kB}, ContextModel::Sequence{4}}) {
      double sum = 0;
      for (int stream = 0; stream < 3; ++stream) {
        const double variance = 1 + stream, d = frame == 0 ? 0.5 : -1;
        sum += 13 * -0.5 * (std::log(2 * std::numbers::pi * variance) + d * d / variance);
      }
      if (sequence == 4) sum -= 3 * 10 * 1024 * std::log(1.0001);
      EXPECT_NEAR(scorer.Of(sequence, 2), sum, 1e-3);
    }
  }
}

TEST_F(WordsTest, DamagedContextsAreToldWithTheFile) {
  hand.Definition(
      "BMDF",
      HandModel::Bytes(std::int16_t{0}) + HandModel::Bytes(std::int16_t{9}) + HandModel::Bytes(7U),
      1, 3, 1);
  EXPECT_EQ(Contexts().error().text, File("mdef") + ": a context that leads out of the file found");
  hand.Definition("BMDF", "", 1, 3, 0);
  EXPECT_EQ(Contexts().error().text, File("mdef") + ": states or a phone that are not there found");
}

TEST_F(WordsTest, WordsAreAsLikelyAsTheLanguageModelSays) {
  Likelihoods({{"ab", -1}, {"c", -2.5}});
  const auto words = ReadWordLikelihoods(File("lm"));
  ASSERT_TRUE(words) << words.error().text;
  ASSERT_EQ(words->size(), 2U);
  EXPECT_NEAR(words->at("ab"), -1, 1e-4);
  EXPECT_NEAR(words->at("c"), -2.5, 1e-4);

  Likelihoods({{"ab", -1}, {"c", 2}});
  EXPECT_EQ(ReadWordLikelihoods(File("lm")).error().text, File("lm") + ": word 1 is damaged");
  hand.Write("lm", "Trie Language Model\7");
  EXPECT_EQ(ReadWordLikelihoods(File("lm")).error().text,
            File("lm") + ": an order of 2 to 5 expected");
  hand.Write("lm", "\\data\\");
  EXPECT_EQ(ReadWordLikelihoods(File("lm")).error().text,
            File("lm") + ": no language model as a trie found");
}

TEST_F(WordsTest, NoByteOfTheFilesLeadsAstray) {
  Likelihoods({{"ab", -1}, {"ca", -1}});
  hand.Write("dict", "ab A B\nca C A\n");
  for (const std::string& name : {std::string("mdef"), std::string("lm")}) {
    std::ifstream file(File(name), std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(file), {});
    // Of the long table of quantised numbers only some.
    for (std::size_t at = 0;
         at<whole.size(); at += at> 100 && at + 200 < whole.size() ? 50021 : 1) {
      for (const char byte : {'\0', '\x7F', '\xFF'}) {
        std::string damaged = whole;
        damaged[at] = byte;
        hand.Write(name, damaged);
        auto phones = PhoneModel::Read(hand.folder);
        if (!phones) continue;
        auto contexts = ContextModel::Read(hand.folder, *phones);
        if (!contexts) continue;
        const auto tree = WordTree::Read(File("dict"), File("lm"), std::move(*contexts));
        if (!tree) continue;
        WordDecoder decoder(**tree);
        const auto frames = Said({{0, 3}});
        for (int i = 0; i < 3; ++i) decoder.Add(frames.data());
      }
    }
    hand.Write(name, whole);
  }
}

TEST_F(WordsTest, WordsThatBeginAlikeShareTheirFirstPhones) {
  Likelihoods({{"abc", -1}, {"ab", -2}, {"c", -3}});
  const auto tree = Tree("ab A B\nabc A B C\nabc(2) A B A\nc C\nunknown C C\n");
  ASSERT_TRUE(tree) << tree.error().text;
  // A before B and C; below, B at an end, before C and before A, and what follows these.
  ASSERT_EQ((*tree)->roots(), 2U);
  const auto& nodes = (*tree)->nodes();
  ASSERT_EQ(nodes.size(), 7U);
  EXPECT_EQ(nodes[0].phone, kA);
  EXPECT_EQ(nodes[0].next, kB);
  EXPECT_NEAR(nodes[0].likely, -1, 1e-4);
  EXPECT_EQ(nodes[0].word, WordTree::kNever);
  ASSERT_EQ(nodes[0].children, 3U);
  EXPECT_NEAR(nodes[nodes[0].first_child].word, -2, 1e-4);
  EXPECT_EQ(nodes[nodes[0].first_child + 1].states, 4);  // B between A and C
  EXPECT_NEAR(nodes[1].word, -3, 1e-4);
}

TEST_F(WordsTest, ADictionaryIsRefusedWithItsLine) {
  Likelihoods({{"ab", -1}});
  EXPECT_EQ(Tree("ab A B\nab A X\n").error().text,
            File("dict") + ":2: 'X' found, a phone expected");
  EXPECT_EQ(Tree("ab\n").error().text, File("dict") + ":1: WORD and 1 to 64 phones expected");
  EXPECT_EQ(Tree("other A\n").error().text,
            File("dict") + ":1: no word found that is also in the language model");
  std::filesystem::remove(hand.folder / "dict");
  EXPECT_FALSE(WordTree::Read(File("dict"), File("lm"), *Contexts()));
}

TEST_F(WordsTest, WordsDecideWhatASoundAloneCannot) {
  Likelihoods({{"ab", -1}, {"ca", -1}});
  const auto tree = Tree("ab A B\nca C A\n");
  ASSERT_TRUE(tree) << tree.error().text;
  const auto likely = [&](const std::vector<std::pair<double, int>>& phones, std::size_t back) {
    WordDecoder decoder(**tree);
    const auto frames = Said(phones);
    for (std::size_t at = 0; at < frames.size(); at += PhoneModel::kFeatures) {
      decoder.Add(&frames[at]);
    }
    std::vector<float> out(4);
    decoder.Phones(back, out);
    return out;
  };
  // Halfway between B and C: behind an A it is B, and with an A behind it C.
  const auto behind = likely({{0, 8}, {1.5, 8}}, 0);
  EXPECT_GT(behind[kB], 2 * behind[kC]);
  EXPECT_GT(likely({{3, 5}, {1.5, 6}, {0, 5}}, 7)[kC], 0.9F);
  EXPECT_NEAR(likely({{0, 8}, {1, 8}}, 0)[kB], 1, 0.1);
}

TEST_F(WordsTest, TheNextPhoneOfTheWordIsToldBeforeItIsHeard) {
  Likelihoods({{"ab", -1}, {"c", -1}});
  const auto tree = Tree("ab A B\nc C\n");
  ASSERT_TRUE(tree) << tree.error().text;
  WordDecoder decoder(**tree);
  std::vector<float> next(4);
  const auto hear = [&](double phone) {
    const auto frames = Said({{phone, 8}});
    for (std::size_t at = 0; at < frames.size(); at += PhoneModel::kFeatures)
      decoder.Add(&frames[at]);
    decoder.NextPhones(next);
  };
  hear(0);
  EXPECT_GT(next[kB], 0.9F);
  hear(2);
  EXPECT_LT(next[kB], 0.1F);
}

}  // namespace
}  // namespace vdm
