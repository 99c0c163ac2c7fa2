#pragma once

#include <boost/dynamic_bitset.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "task_manager/grammar/model.h"

namespace vxml::srgs {

/// Places of an input, one bit each. A place is where a word may begin or end, counted from 0.
using Places = boost::dynamic_bitset<std::uint64_t>;

/// Finds where each expansion may end from each place of one input where it may begin: a chart
/// parser. A cell holds the ends of one expansion from one place. Cells of later places never need
/// those of earlier ones, so the latest place with work goes first; what comes from later places is
/// then whole when it is taken, a machine word of places at a time. Only cells of the same place
/// may need each other (left and cyclic recursion, empty expansions): they tell each other what is
/// new until nothing is. Time O(|G| n^3 / 64), memory O(|G| n^2 / 64) bits' words for n places,
/// whatever the recursion.
/// Limit: kMaxSteps (matcher.h); beyond it over_limit() is true and the ends are not to be used.
/// Thread: one instance, one thread. Lifetime: the grammar outlives it.
class Chart {
 public:
  /// `split_digits`: figures and words need no blank between them.
  Chart(const std::string& input, bool dtmf, bool split_digits);

  const std::string& text() const { return text_; }   ///< the input as it is compared
  std::size_t size() const { return bytes_.size(); }  ///< places; the last is the input's end
  std::size_t last() const { return size() - 1; }
  /// The words between two places, without the blank in front.
  std::string Words(std::size_t begin, std::size_t end) const;
  std::size_t ByteOf(std::size_t place) const { return bytes_[place]; }

  /// Where the expansion may end if it begins at `place`.
  Places Ends(const Expansion& node, std::size_t place);

  bool over_limit() const { return steps_ > limit_; }
  /// Some token reached the end of the input: a longer input might match.
  bool touched_end() const { return touched_end_; }
  /// Counts work, about one machine word's worth each. False: over the limit.
  bool Spend(std::size_t steps);

 private:
  using CellId = std::uint32_t;

  /// A cell that takes the new ends of another one of the same place, from one of its stages.
  struct Listener {
    CellId cell;
    std::size_t stage;
  };
  /// How far one expansion got from one place. Stage i of a sequence lies behind its first i parts,
  /// of a repeat behind i turns (the last counts "so many or more"), of the others 0 is before and
  /// 1 behind.
  struct Cell {
    const Expansion* node;
    std::size_t place;
    std::size_t least;  ///< the first stage that is an end
    std::size_t most;   ///< the last stage
    bool endless;       ///< turns beyond `most` stay in it
    std::vector<Places> stages;
    Places ends;
    Places untold;  ///< ends that the listeners have not been told
    std::vector<Listener> listeners;
  };
  /// To go on with a cell's stage from a place it has reached.
  struct Step {
    CellId cell;
    std::size_t stage;
    std::size_t from;
  };
  struct Work {
    std::vector<Step> steps;
    std::vector<CellId> to_tell;
  };
  struct Key {
    const Expansion* node;
    std::size_t place;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      return std::hash<const void*>()(key.node) * 1000003U + key.place;
    }
  };

  void FindPlaces();
  bool AtWordEnd(std::size_t byte) const;
  std::size_t SkipBlank(std::size_t byte) const;
  /// The ends of what has no parts.
  Places OfLeaf(const Expansion& node, std::size_t place);
  Places OfToken(const Expansion& node, std::size_t place);

  CellId Open(const Expansion& node, std::size_t place);
  void Run();
  void Advance(const Step& step);
  /// False: the part's cell had to be opened at a later place first.
  bool AdvanceThrough(const Step& step, const Expansion& part);
  /// A part that begins where `step` stands may end at `ends`.
  void Reach(CellId id, std::size_t stage, std::size_t from, Places ends);
  void Enter(CellId id, std::size_t stage, const Places& places);
  void Tell(CellId id);

  std::string text_;
  bool dtmf_;
  bool split_digits_;
  std::vector<std::size_t> bytes_;      ///< of each place
  std::vector<std::int32_t> place_at_;  ///< of each byte, -1 where there is none
  std::vector<Cell> cells_;
  std::unordered_map<Key, CellId, KeyHash> by_key_;
  std::vector<Work> work_;  ///< of each place
  std::size_t latest_ = 0;  ///< no place behind it has work
  std::size_t words_;       ///< machine words of one set of places
  std::size_t steps_ = 0;
  std::size_t limit_;
  bool touched_end_ = false;
};

}  // namespace vxml::srgs
