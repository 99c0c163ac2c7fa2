#include "vdm/train/triphone_training.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "embedded/questions.h"

namespace vdm {
namespace {

using Entry = std::pair<const Triphone*, const Statistics*>;

Statistics Nothing() {
  const auto size = static_cast<Eigen::Index>(kWindows * kTrackNumbers);
  return {0, Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)};
}

/// Grows the tree of one state.
class TreeGrower {
 public:
  TreeGrower(const std::vector<PhonemeSet>& sets, const TreePlan& plan,
             const std::map<Triphone, Statistics>& seen)
      : sets_(sets), plan_(plan), all_(Nothing()) {
    std::vector<Entry> entries;
    for (const auto& [triphone, statistics] : seen) {
      entries.emplace_back(&triphone, &statistics);
      all_.Add(statistics);
    }
    floor_ = Eigen::VectorXd::Constant(all_.sum.size(), kLeastVariance);
    floor_ = (plan.variance_floor * Variances(all_)).cwiseMax(floor_).eval();
    leaves_.push_back(MakeLeaf(0, std::move(entries)));
    nodes_.emplace_back();
  }

  std::vector<TreeNode> Grow() {
    const double parameters = 2.0 * static_cast<double>(all_.sum.size());
    const double least = plan_.cost * 0.5 * parameters * std::log(all_.count);
    while (leaves_.size() < plan_.leaves) {
      const auto best = std::ranges::max_element(
          leaves_, {}, [](const Leaf& leaf) { return leaf.split ? leaf.split->gain : 0; });
      if (!best->split || best->split->gain <= least) break;
      Split(*best);
    }
    for (const Leaf& leaf : leaves_) {
      nodes_[leaf.node].expectation = {leaf.sum.sum / leaf.sum.count, Variances(leaf.sum)};
    }
    return std::move(nodes_);
  }

 private:
  static constexpr double kLeastVariance = 1e-6;

  struct Question {
    Side side = Side::kCentre;
    int set = 0;
    double gain = 0;
  };
  struct Leaf {
    std::size_t node = 0;
    std::vector<Entry> entries;
    Statistics sum{};
    std::optional<Question> split{};
  };

  Eigen::VectorXd Variances(const Statistics& s) const {
    const Eigen::VectorXd mean = s.sum / s.count;
    Eigen::VectorXd variances = s.squares / s.count - mean.cwiseProduct(mean);
    return floor_.size() == 0 ? variances : variances.cwiseMax(floor_);
  }
  /// Logarithm of how likely the instants are by a Gaussian of their own, less what is the same for
  /// all.
  double Likelihood(const Statistics& s) const {
    return -0.5 * s.count * Variances(s).array().log().sum();
  }
  bool Yes(const Triphone& triphone, Side side, std::size_t set) const {
    const std::string& phoneme = side == Side::kLeft     ? triphone.left
                                 : side == Side::kCentre ? triphone.centre
                                                         : triphone.right;
    return sets_[set].phonemes.contains(phoneme);
  }

  Leaf MakeLeaf(std::size_t node, std::vector<Entry> entries) const {
    Leaf leaf{.node = node, .entries = std::move(entries), .sum = Nothing()};
    for (const Entry& entry : leaf.entries) leaf.sum.Add(*entry.second);
    leaf.split = BestQuestion(leaf);
    return leaf;
  }

  std::optional<Question> BestQuestion(const Leaf& leaf) const {
    std::optional<Question> best;
    const double before = Likelihood(leaf.sum);
    for (const Side side : {Side::kLeft, Side::kCentre, Side::kRight}) {
      for (std::size_t set = 0; set < sets_.size(); ++set) {
        Statistics yes = Nothing();
        for (const auto& [triphone, statistics] : leaf.entries) {
          if (Yes(*triphone, side, set)) yes.Add(*statistics);
        }
        const Statistics no{leaf.sum.count - yes.count, leaf.sum.sum - yes.sum,
                            leaf.sum.squares - yes.squares};
        if (std::min(yes.count, no.count) < plan_.least_instants) continue;
        const double gain = Likelihood(yes) + Likelihood(no) - before;
        if (!best || gain > best->gain) best = {side, static_cast<int>(set), gain};
      }
    }
    return best;
  }

  void Split(Leaf& leaf) {
    const Question question = *leaf.split;
    std::vector<Entry> yes, no;
    for (const Entry& entry : leaf.entries) {
      const bool is = Yes(*entry.first, question.side, static_cast<std::size_t>(question.set));
      (is ? yes : no).push_back(entry);
    }
    const std::size_t first = nodes_.size();
    nodes_.resize(first + 2);
    TreeNode& node = nodes_[leaf.node];
    node = {.side = question.side, .set = question.set, .yes = first, .no = first + 1};
    leaf = MakeLeaf(first, std::move(yes));
    leaves_.push_back(MakeLeaf(first + 1, std::move(no)));
  }

  const std::vector<PhonemeSet>& sets_;
  const TreePlan& plan_;
  Statistics all_;
  Eigen::VectorXd floor_;
  std::vector<Leaf> leaves_;
  std::vector<TreeNode> nodes_;
};

}  // namespace

const std::vector<PhonemeSet>& BuiltPhonemeSets() {
  static const std::vector<PhonemeSet> built = [] {
    auto read = ReadPhonemeSets("questions.txt", embedded::questions());
    if (!read) throw std::runtime_error(read.error().text);
    return std::move(*read);
  }();
  return built;
}

void Statistics::Add(const Statistics& other) {
  count += other.count;
  sum += other.sum;
  squares += other.squares;
}

void TriphoneTraining::Add(const vm::PhonemeList& phonemes, const MouthTruth& truth) {
  Eigen::MatrixXd track(static_cast<Eigen::Index>(kTrackNumbers), truth.shape.cols());
  track << truth.shape.cast<double>(), truth.closed.cast<double>().transpose();
  const Eigen::MatrixXd windows = WindowsOf(track);
  for (const TriphoneState& state : StatesOf(phonemes, step_ms_)) {
    const std::size_t end = std::min(state.end, static_cast<std::size_t>(windows.cols()));
    if (state.first >= end) continue;
    const auto block = windows.middleCols(static_cast<Eigen::Index>(state.first),
                                          static_cast<Eigen::Index>(end - state.first));
    const auto found = seen_[state.state].try_emplace(state.triphone, Nothing()).first;
    found->second.Add({static_cast<double>(block.cols()), block.rowwise().sum(),
                       block.cwiseAbs2().rowwise().sum()});
  }
}

vm::Result<TriphoneModel> TriphoneTraining::Grow(const std::vector<PhonemeSet>& sets,
                                                 const TreePlan& plan) const {
  TriphoneModel model{.step_ms = step_ms_, .sets = sets};
  for (std::size_t state = 0; state < kStates; ++state) {
    if (seen_[state].empty()) {
      return vm::Fail(vm::Errc::kBadValue, "no phonemes to learn from");
    }
    model.trees[state] = TreeGrower(sets, plan, seen_[state]).Grow();
  }
  return model;
}

}  // namespace vdm
