#include "fsm/render/rig_items.h"

#include <array>
#include <bit>
#include <glm/vec3.hpp>

#include "fsm/rig/rig.h"

namespace fsm {
namespace {

// What stands in RigItems::words, of 32-bit numbers without gaps: the shader reads the members in
// this order, and is told the sizes.

/// Of a vertex with a list: its entries lie in `from`..`to`, behind the records.
struct ListRecord {
  std::uint32_t vertex, from, to;
};
struct PlaceRecord {
  glm::vec3 rest, rest_normal;
};
struct ChannelEntry {
  std::uint32_t channel;
  glm::vec3 by;
};
struct LidRecord {
  std::uint32_t vertex, side;
  float upper, lower, upper_angle, lower_angle, meet_angle, opening, y, z;
  std::uint32_t proper;
};
struct BallLidRecord {
  std::uint32_t vertex, side;
  float least;
};
struct JawRecord {
  std::uint32_t vertex;
  float weight;
};
struct ChinRecord {
  std::uint32_t vertex;
  glm::vec3 from_hinge;
};
struct ContactRecord {
  std::uint32_t vertex;
  float upper_gap, lower_gap;
};
struct GapRecord {
  std::uint32_t upper, lower;
  glm::vec3 apart_at_rest;
};
struct LipEntry {
  std::uint32_t pair;
  float share;
};
struct TongueRecord {
  std::uint32_t vertex;
  glm::vec3 rest, rest_normal;
  float tip;
};
struct SeamEntry {
  std::uint32_t upper, lower;
};
struct BoneRecord {
  std::uint32_t vertex, bone;
};
struct NeckRecord {
  float weight;
  std::uint32_t turns_normal;
};
struct SpringEntry {
  std::uint32_t spring;
  float weight;
};
struct TriangleEntry {
  std::uint32_t a, b, c;
};

template <typename T>
constexpr std::uint32_t kWords = sizeof(T) / sizeof(std::uint32_t);

template <typename T>
void Append(std::vector<std::uint32_t>& words, const T& record) {
  const auto numbers = std::bit_cast<std::array<std::uint32_t, kWords<T>>>(record);
  words.insert(words.end(), numbers.begin(), numbers.end());
}

template <typename Record>
RigItems ItemsOf(const char* step, const std::vector<Record>& records) {
  RigItems items{
      .step = step, .words = {}, .count = records.size(), .record_words = kWords<Record>};
  for (const Record& record : records) Append(items.words, record);
  return items;
}

/// What acts on each vertex, as lists. Entries keep their order, so that sums are taken in the same
/// order as on the processor.
template <typename Entry>
class VertexLists {
 public:
  explicit VertexLists(std::size_t vertices) : entries_(vertices) {}
  std::vector<Entry>& operator[](std::uint32_t vertex) { return entries_[vertex]; }
  /// A ListRecord for each vertex on which something acts, then the entries.
  RigItems Items(const char* step) const {
    std::vector<ListRecord> records;
    std::vector<std::uint32_t> behind;
    for (std::uint32_t vertex = 0; vertex < entries_.size(); ++vertex) {
      if (entries_[vertex].empty()) continue;
      const auto from = static_cast<std::uint32_t>(behind.size());
      for (const Entry& entry : entries_[vertex]) Append(behind, entry);
      records.push_back({vertex, from, static_cast<std::uint32_t>(behind.size())});
    }
    const auto begin = static_cast<std::uint32_t>(records.size() * kWords<ListRecord>);
    for (ListRecord& record : records) record.from += begin, record.to += begin;
    RigItems items = ItemsOf(step, records);
    items.entry_words = kWords<Entry>;
    items.words.insert(items.words.end(), behind.begin(), behind.end());
    return items;
  }

 private:
  std::vector<std::vector<Entry>> entries_;  // by vertex
};

RigItems PlaceItems(const RigData& data) {
  std::vector<PlaceRecord> records;
  for (std::size_t i = 0; i < data.rest.size(); ++i)
    records.push_back({data.Start()[i], data.rest_normal[i]});
  return ItemsOf("begin", records);
}

RigItems ChannelItems(const RigData& data) {
  VertexLists<ChannelEntry> lists(data.rest.size());
  for (std::uint32_t k = 0; k < data.channels.size(); ++k) {
    for (const Displacement& move : data.channels[k].moves)
      lists[move.vertex].push_back({k, move.by});
  }
  return lists.Items("channels");
}

RigItems LidItems(const LidRig& lids) {
  std::vector<LidRecord> records;
  for (const LidRig::Vertex& lid : lids.vertices) {
    records.push_back({lid.vertex, static_cast<std::uint32_t>(lid.side), lid.upper, lid.lower,
                       lid.upper_angle, lid.lower_angle, lid.meet_angle, lid.opening, lid.y, lid.z,
                       lid.proper ? 1u : 0u});
  }
  return ItemsOf("lids", records);
}

RigItems BallLidItems(const BallLids& lids) {
  std::vector<BallLidRecord> records;
  for (const BallLids::Vertex& lid : lids.vertices)
    records.push_back({lid.vertex, static_cast<std::uint32_t>(lid.side), lid.least});
  return ItemsOf("lids_on_balls", records);
}

RigItems JawItems(const RigData& data) {
  std::vector<JawRecord> records;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (Rig::MovesWithJaw(data, i)) records.push_back({i, data.weights[i].jaw});
  }
  return ItemsOf("jaw", records);
}

RigItems ContactItems(const TeethRig& teeth) {
  std::vector<ContactRecord> records;
  for (const TeethRig::Contact& contact : teeth.contacts)
    records.push_back({contact.vertex, contact.upper_gap, contact.lower_gap});
  return ItemsOf("teeth", records);
}

RigItems GapItems(const LipRig& lips) {
  std::vector<GapRecord> records;
  for (std::size_t k = 0; k < lips.seam.size(); ++k) {
    records.push_back({lips.seam[k].first, lips.seam[k].second,
                       lips.apart_at_rest.empty() ? glm::vec3(0) : lips.apart_at_rest[k]});
  }
  return ItemsOf("lip_gaps", records);
}

RigItems LipItems(const RigData& data) {
  VertexLists<LipEntry> lists(data.rest.size());
  for (const LipRig::Follower& f : data.lips.followers)
    lists[f.vertex].push_back({f.pair, LipRig::ShareOf(f)});
  return lists.Items("lips");
}

/// The vertices of the tongue; behind their records the pairs of the seam.
RigItems TongueItems(const RigData& data) {
  std::vector<TongueRecord> records;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] != Bone::kTongue) continue;
    records.push_back({i, data.rest[i], data.rest_normal[i], data.weights[i].free});
  }
  RigItems items = ItemsOf("tongue", records);
  items.entry_words = kWords<SeamEntry>;
  Append(items.words, static_cast<std::uint32_t>(data.lips.seam.size()));
  for (const auto& [upper, lower] : data.lips.seam) Append(items.words, SeamEntry{upper, lower});
  return items;
}

RigItems BoneItems(const RigData& data) {
  std::vector<BoneRecord> records;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] == Bone::kJaw) records.push_back({i, 0});
    if (data.bone[i] == Bone::kEyeRight) records.push_back({i, 1});
    if (data.bone[i] == Bone::kEyeLeft) records.push_back({i, 2});
  }
  return ItemsOf("bones", records);
}

RigItems NeckItems(const RigData& data) {
  std::vector<NeckRecord> records;
  for (std::size_t i = 0; i < data.rest.size(); ++i)
    records.push_back({data.weights[i].neck, data.bone[i] != Bone::kSkin ? 1u : 0u});
  return ItemsOf("neck", records);
}

RigItems SpringItems(const RigData& data) {
  VertexLists<SpringEntry> lists(data.rest.size());
  for (const auto& [vertex, spring, weight] : data.swing.weights)
    lists[vertex].push_back({spring, weight});
  return lists.Items("springs");
}

/// A vertex gathers from all triangles about it, and about those it shares its normal with.
RigItems NormalItems(const RigData& data) {
  const NormalRig& normals = data.normals;
  const std::vector<std::uint32_t>& t = normals.soft_triangles;
  VertexLists<TriangleEntry> lists(data.rest.size());
  for (std::size_t k = 0; k + 2 < t.size(); k += 3) {
    for (std::size_t c = 0; c < 3; ++c)
      lists[normals.Owner(t[k + c])].push_back({t[k], t[k + 1], t[k + 2]});
  }
  for (const std::uint32_t i : t) {
    if (normals.Owner(i) != i) lists[i] = lists[normals.Owner(i)];
  }
  return lists.Items("normals");
}

}  // namespace

std::vector<RigItems> ItemsOfSteps(const RigData& data) {
  std::vector<RigItems> all{PlaceItems(data)};
  for (const RigStep step : data.steps) {
    switch (step) {
      using enum RigStep;
      case kChannels:
        all.push_back(ChannelItems(data));
        break;
      case kLids:
        all.push_back(LidItems(data.lids));
        break;
      case kLidsOnBalls:
        all.push_back(BallLidItems(data.ball_lids));
        break;
      case kJaw:
        all.push_back(JawItems(data));
        break;
      case kJawByChin: {
        const std::uint32_t chin = data.jaw.chin;
        const ChinRecord record{chin, data.rest[chin] - data.jaw.hinge};
        all.push_back(ItemsOf("jaw_by_chin", std::vector{record}));
        break;
      }
      case kTeeth:
        all.push_back(ContactItems(data.teeth));
        break;
      case kLips:
        all.push_back(GapItems(data.lips));
        all.push_back(LipItems(data));
        break;
      case kOwnForm:
        all.push_back(ItemsOf("own_form", data.proxy.to_own));
        break;
      case kTongue:
        all.push_back(TongueItems(data));
        break;
      case kBones:
        all.push_back(BoneItems(data));
        break;
      case kNeck:
        all.push_back(NeckItems(data));
        break;
      case kSprings:
        all.push_back(SpringItems(data));
        break;
      case kNormals:
        all.push_back(NormalItems(data));
        break;
    }
  }
  std::erase_if(all, [](const RigItems& items) { return items.count == 0; });
  return all;
}

}  // namespace fsm
