#include "fsm/render/rig_records.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <type_traits>

#include "fsm/rig/rig_steps.h"

namespace fsm {
namespace {

using step::PointAt;

template <typename T>
std::vector<std::byte> BytesOf(const std::vector<T>& all) {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) == sizeof(float));
  const auto bytes = std::as_bytes(std::span(all));
  return {bytes.begin(), bytes.end()};
}

template <typename Record, typename Entry = step::ListRecord>
RigRecords RecordsOf(const char* step, const std::vector<Record>& records,
                     const std::vector<Entry>& entries = {}) {
  return {.step = step,
          .count = records.size(),
          .records = BytesOf(records),
          .entries = BytesOf(entries)};
}

/// Lists of the entries that act on each vertex. Entries keep their order, so that sums are
/// computed in the same order as on the processor.
template <typename Entry>
class VertexLists {
 public:
  explicit VertexLists(std::size_t vertices) : lists_(vertices) {}
  std::vector<Entry>& operator[](std::uint32_t vertex) { return lists_[vertex]; }
  /// Returns a record for each vertex with a non-empty list.
  RigRecords Records(const char* step) const {
    std::vector<step::ListRecord> records;
    std::vector<Entry> entries;
    for (std::uint32_t vertex = 0; vertex < lists_.size(); ++vertex) {
      if (lists_[vertex].empty()) continue;
      const auto from = static_cast<std::uint32_t>(entries.size());
      entries.insert(entries.end(), lists_[vertex].begin(), lists_[vertex].end());
      records.push_back({vertex, from, static_cast<std::uint32_t>(entries.size())});
    }
    return RecordsOf(step, records, entries);
  }

 private:
  std::vector<std::vector<Entry>> lists_;  // by vertex
};

RigRecords PlaceRecords(const RigData& data) {
  std::vector<step::PlaceRecord> records;
  for (std::size_t i = 0; i < data.rest.size(); ++i)
    records.push_back({PointAt(data.Start()[i]), PointAt(data.rest_normal[i])});
  return RecordsOf("begin", records);
}

RigRecords ChannelRecords(const RigData& data) {
  VertexLists<step::ChannelEntry> lists(data.rest.size());
  for (std::uint32_t k = 0; k < data.channels.size(); ++k) {
    for (const Displacement& move : data.channels[k].moves)
      lists[move.vertex].push_back({k, PointAt(move.by)});
  }
  return lists.Records("channels");
}

RigRecords LidRecords(const LidRig& lids) {
  std::vector<step::LidRecord> records;
  for (const LidRig::Vertex& lid : lids.vertices) {
    records.push_back(
        {lid.vertex, static_cast<std::uint32_t>(lid.side), lid.at, lid.proper ? 1U : 0U});
  }
  return RecordsOf("lids", records);
}

RigRecords BallLidRecords(const BallLids& lids) {
  std::vector<step::BallLidRecord> records;
  for (const BallLids::Vertex& lid : lids.vertices)
    records.push_back({lid.vertex, static_cast<std::uint32_t>(lid.side), lid.least});
  return RecordsOf("lids_on_balls", records);
}

RigRecords JawRecords(const RigData& data) {
  std::vector<step::JawRecord> records;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (MovesWithJaw(data, i)) records.push_back({i, data.weights[i].jaw});
  }
  return RecordsOf("jaw", records);
}

RigRecords ContactRecords(const TeethRig& teeth) {
  std::vector<step::ContactRecord> records;
  for (const TeethRig::Contact& contact : teeth.contacts)
    records.push_back({contact.vertex, contact.upper_gap, contact.lower_gap});
  return RecordsOf("teeth", records);
}

RigRecords GapRecords(const LipRig& lips) {
  std::vector<step::GapRecord> records;
  for (std::size_t k = 0; k < lips.seam.size(); ++k)
    records.push_back({lips.seam[k].first, lips.seam[k].second, PointAt(lips.ApartAtRest(k))});
  return RecordsOf("lip_gaps", records);
}

RigRecords LipRecords(const RigData& data) {
  VertexLists<step::LipEntry> lists(data.rest.size());
  for (const LipRig::Follower& f : data.lips.followers)
    lists[f.vertex].push_back({f.pair, LipRig::ShareOf(f)});
  return lists.Records("lips");
}

/// Records are the vertices of the tongue; entries are the pairs of the lip seam.
RigRecords TongueRecords(const RigData& data) {
  std::vector<step::TongueRecord> records;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] != Bone::kTongue) continue;
    records.push_back(
        {i, PointAt(data.rest[i]), PointAt(data.rest_normal[i]), data.weights[i].free});
  }
  std::vector<step::SeamEntry> seam;
  for (const auto& [upper, lower] : data.lips.seam) seam.push_back({upper, lower});
  return RecordsOf("tongue", records, seam);
}

RigRecords BoneRecords(const RigData& data) {
  std::vector<step::BoneRecord> records;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] == Bone::kJaw) records.push_back({i, step::kJawBone});
    if (const auto eye = EyeOf(data.bone[i])) records.push_back({i, std::uint32_t(*eye)});
  }
  return RecordsOf("bones", records);
}

RigRecords NeckRecords(const RigData& data) {
  std::vector<step::NeckRecord> records;
  for (std::size_t i = 0; i < data.rest.size(); ++i)
    records.push_back({data.weights[i].neck, data.bone[i] != Bone::kSkin ? 1U : 0U});
  return RecordsOf("neck", records);
}

RigRecords SpringRecords(const RigData& data) {
  VertexLists<step::SpringEntry> lists(data.rest.size());
  for (const auto& [vertex, spring, weight] : data.swing.weights)
    lists[vertex].push_back({spring, weight});
  return lists.Records("springs");
}

/// Each vertex lists all triangles around it and around the vertices that share its normal.
RigRecords NormalRecords(const RigData& data) {
  const NormalRig& normals = data.normals;
  const std::vector<std::uint32_t>& t = normals.soft_triangles;
  VertexLists<step::TriangleEntry> lists(data.rest.size());
  for (std::size_t k = 0; k + 2 < t.size(); k += 3) {
    for (std::size_t c = 0; c < 3; ++c)
      lists[normals.Owner(t[k + c])].push_back({t[k], t[k + 1], t[k + 2]});
  }
  for (const std::uint32_t i : t) {
    if (normals.Owner(i) != i) lists[i] = lists[normals.Owner(i)];
  }
  return lists.Records("normals");
}

}  // namespace

std::vector<RigRecords> RecordsOfSteps(const RigData& data) {
  std::vector<RigRecords> all{PlaceRecords(data)};
  for (const RigStep step : data.steps) {
    switch (step) {
      using enum RigStep;
      case kChannels:
        all.push_back(ChannelRecords(data));
        break;
      case kLids:
        all.push_back(LidRecords(data.lids));
        break;
      case kLidsOnBalls:
        all.push_back(BallLidRecords(data.ball_lids));
        break;
      case kJaw:
        all.push_back(JawRecords(data));
        break;
      case kJawByChin: {
        const std::uint32_t chin = data.jaw.chin;
        const step::ChinRecord record{chin, PointAt(data.rest[chin])};
        all.push_back(RecordsOf("jaw_by_chin", std::vector{record}));
        break;
      }
      case kTeeth:
        all.push_back(ContactRecords(data.teeth));
        break;
      case kLips:
        all.push_back(GapRecords(data.lips));
        all.push_back(LipRecords(data));
        break;
      case kOwnForm:
        all.push_back(RecordsOf("own_form", data.proxy.to_own));
        break;
      case kTongue:
        all.push_back(TongueRecords(data));
        break;
      case kBones:
        all.push_back(BoneRecords(data));
        break;
      case kNeck:
        all.push_back(NeckRecords(data));
        break;
      case kSprings:
        all.push_back(SpringRecords(data));
        break;
      case kNormals:
        all.push_back(NormalRecords(data));
        break;
    }
  }
  std::erase_if(all, [](const RigRecords& one) { return one.count == 0; });
  return all;
}

}  // namespace fsm
