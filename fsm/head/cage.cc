#include "fsm/head/cage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "fsm/base/parse_number.h"
#include "fsm/base/spline.h"
#include "fsm/head/cage_rings.h"

namespace fsm {
namespace {

std::uint32_t AddPoint(Cage& cage, glm::vec3 p, const CageTag& tag = {}) {
  cage.position.push_back(p);
  cage.tag.push_back(tag);
  return static_cast<std::uint32_t>(cage.position.size() - 1);
}

float NumberIn(const TableRow& row, std::string_view word) {
  const auto number = ParseNumber<float>(word);
  if (!number) row.Refuse(fmt::format("'{}' found where a number was expected", word));
  return *number;
}

const std::vector<std::uint32_t>& FindCurve(const Cage& cage, const TableRow& row,
                                            std::string_view name) {
  const auto found = cage.curves.find(name);
  if (found == cage.curves.end()) row.Refuse(fmt::format("there is no curve '{}'", name));
  return found->second;
}

glm::vec3 ParsePlace(const TableRow& row, std::string_view word) {
  glm::vec3 p(0);
  for (int k = 0; k < 3; ++k) {
    const std::size_t comma = word.find(',');
    if ((comma == std::string_view::npos) != (k == 2)) row.Refuse("a place is x,y,z");
    p[k] = NumberIn(row, word.substr(0, comma));
    word.remove_prefix(comma == std::string_view::npos ? word.size() : comma + 1);
  }
  return p;
}

/// Evaluates a spline through points with one parameter value each.
glm::vec3 SplineAt(const std::vector<float>& at, const std::vector<glm::vec3>& p, float t) {
  const SplineBasis basis(at);
  std::vector<float> weights(at.size());
  basis.Weights(t, weights);
  glm::vec3 sum(0);
  for (std::size_t i = 0; i < p.size(); ++i) sum += weights[i] * p[i];
  return sum;
}

void ReadCurveRow(const TableRow& row, Cage& cage) {
  const std::string& name = row.Word(1);
  std::vector<std::uint32_t> points;
  std::vector<std::size_t> open;
  std::vector<float> given_at;
  std::vector<glm::vec3> given;
  for (std::size_t i = 2; i < row.size(); ++i) {
    const std::string& word = row.Word(i);
    if (word == "~") {
      open.push_back(points.size());
      points.push_back(AddPoint(cage, {}));
      continue;
    }
    points.push_back(word.find(',') != std::string::npos ? AddPoint(cage, ParsePlace(row, word))
                                                         : CagePoint(cage, row, word));
    given_at.push_back(static_cast<float>(i));
    given.push_back(cage.position[points.back()]);
  }
  if (points.empty()) row.Refuse("a curve needs points");
  if (!open.empty() && (given.size() < 2 || open.front() == 0 || open.back() + 1 == points.size()))
    row.Refuse("~ must lie between given points");
  for (const std::size_t i : open) {
    cage.position[points[i]] = SplineAt(given_at, given, static_cast<float>(i + 2));
  }
  auto& curve = cage.curves[name];
  curve.insert(curve.end(), points.begin(), points.end());
}

SkinKind ReadKind(const TableRow& row) {
  const std::string& word = row.Word(1);
  if (word == "skin") return SkinKind::kSkin;
  if (word == "rim") return SkinKind::kRim;
  if (word == "lip") return SkinKind::kLip;
  if (word == "inside") return SkinKind::kInside;
  row.Refuse(fmt::format("'{}' found where skin, rim, lip or inside was expected", word));
}

bool ReadFine(const TableRow& row) {
  const std::string& word = row.Word(2);
  if (word != "fine" && word != "plain")
    row.Refuse(fmt::format("'{}' found where fine or plain was expected", word));
  return word == "fine";
}

void AddPolygon(Cage& cage, std::vector<std::uint32_t> corner, SkinKind kind, bool fine) {
  std::vector<std::uint32_t> kept;
  for (const std::uint32_t v : corner) {
    if (std::ranges::find(kept, v) == kept.end()) kept.push_back(v);
  }
  if (kept.size() >= 3) cage.polygons.push_back({std::move(kept), kind, fine});
}

/// Returns the rows of a strip: its curves, with the bands between them filled in.
std::vector<std::vector<std::uint32_t>> StripRows(const TableRow& row, Cage& cage) {
  std::vector<const std::vector<std::uint32_t>*> curves;
  std::vector<int> bands;
  for (std::size_t i = 3; i < row.size(); ++i) {
    if (i % 2 == 1) {
      curves.push_back(&FindCurve(cage, row, row.Word(i)));
      if (curves.back()->size() != curves.front()->size()) {
        row.Refuse(row.Word(i) + " has " + std::to_string(curves.back()->size()) + " points, " +
                   row.Word(3) + " has " + std::to_string(curves.front()->size()));
      }
    } else {
      bands.push_back(row.Integer(i));
      if (bands.back() < 0 || bands.back() > 32) row.Refuse("0 to 32 bands");
    }
  }
  if (curves.size() < 2 || bands.size() + 1 != curves.size()) row.Refuse("CURVE n CURVE expected");
  const std::size_t count = curves.front()->size();
  // The parameter is the length along each column, so that uneven rows make no waves.
  std::vector<std::vector<float>> at(count, {0.0f});
  std::vector<std::vector<glm::vec3>> through(count);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const glm::vec3 p = cage.position[(*curves[k])[c]];
      if (k > 0) at[c].push_back(at[c].back() + 1e-3f + glm::length(p - through[c].back()));
      through[c].push_back(p);
    }
  }
  std::vector<std::vector<std::uint32_t>> rows;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    // A curve with 0 bands only shapes the rows that follow.
    if (k + 1 < curves.size() && bands[k] == 0) continue;
    rows.push_back(*curves[k]);
    if (k + 1 == curves.size()) break;
    for (int b = 1; b < bands[k]; ++b) {
      std::vector<std::uint32_t> between;
      const float share = static_cast<float>(b) / static_cast<float>(bands[k]);
      for (std::size_t c = 0; c < count; ++c) {
        const float t = at[c][k] + share * (at[c][k + 1] - at[c][k]);
        glm::vec3 p = SplineAt(at[c], through[c], t);
        if (through[c][k].x == 0 && through[c][k + 1].x == 0) p.x = 0;
        between.push_back(AddPoint(cage, p));
      }
      rows.push_back(std::move(between));
    }
  }
  return rows;
}

void ReadPatchRow(const TableRow& row, Cage& cage) {
  const std::string& key = row.key();
  const SkinKind kind = ReadKind(row);
  const bool fine = ReadFine(row);
  if (key == "strip" || key == "ring") {
    const auto rows = StripRows(row, cage);
    const std::size_t count = rows.front().size();
    for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
      for (std::size_t c = 0; c < count; ++c) {
        if (key == "strip" && c + 1 == count) break;
        const std::size_t next = (c + 1) % count;
        AddPolygon(cage, {rows[r][c], rows[r][next], rows[r + 1][next], rows[r + 1][c]}, kind,
                   fine);
      }
    }
  } else if (key == "quad") {
    std::vector<std::uint32_t> corner;
    for (std::size_t i = 3; i < 7; ++i) corner.push_back(CagePoint(cage, row, row.Word(i)));
    AddPolygon(cage, std::move(corner), kind, fine);
  } else if (key == "cap") {
    AddPolygon(cage, FindCurve(cage, row, row.Word(3)), kind, fine);
  } else {
    row.Refuse(fmt::format("unknown word '{}'", key));
  }
}

/// Orients all polygons like their neighbours, and then the skin as a whole so that its front faces
/// outward.
void Orient(Cage& cage, const Table& patches) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Edge, std::vector<std::size_t>> by_edge;
  const auto edges = [&](std::size_t f, auto&& visit) {
    const auto& corner = cage.polygons[f].corner;
    for (std::size_t i = 0; i < corner.size(); ++i) {
      visit(corner[i], corner[(i + 1) % corner.size()]);
    }
  };
  for (std::size_t f = 0; f < cage.polygons.size(); ++f) {
    edges(f, [&](std::uint32_t a, std::uint32_t b) { by_edge[std::minmax(a, b)].push_back(f); });
  }
  for (const auto& [edge, faces] : by_edge) {
    if (faces.size() > 2) {
      patches.Refuse("three patches share an edge at point " + std::to_string(edge.first));
    }
  }
  std::vector<bool> seen(cage.polygons.size());
  std::vector<std::size_t> todo = {0};
  seen[0] = true;
  while (!todo.empty()) {
    const std::size_t f = todo.back();
    todo.pop_back();
    edges(f, [&](std::uint32_t a, std::uint32_t b) {
      for (const std::size_t g : by_edge[std::minmax(a, b)]) {
        if (seen[g]) continue;
        seen[g] = true;
        bool same = false;
        edges(g, [&](std::uint32_t c, std::uint32_t d) { same |= c == a && d == b; });
        if (same) std::ranges::reverse(cage.polygons[g].corner);
        todo.push_back(g);
      }
    });
  }
  if (std::ranges::find(seen, false) != seen.end()) {
    patches.Refuse("the skin is not in one piece");
  }
  float outward = 0;
  for (const Cage::Polygon& polygon : cage.polygons) {
    const glm::vec3 a = cage.position[polygon.corner[0]];
    const glm::vec3 n =
        glm::cross(cage.position[polygon.corner[1]] - a, cage.position[polygon.corner[2]] - a);
    outward += glm::dot(n, a - glm::vec3(0, -20, 0));
  }
  if (outward < 0) {
    for (Cage::Polygon& polygon : cage.polygons) std::ranges::reverse(polygon.corner);
  }
}

/// Gives the skin around the mouth a part in closing the lips that decreases with the distance.
void TieSkinToLips(Cage& cage, const Table& table) {
  for (const auto& [name, hold] : {std::pair{"lip_a", 0.8f}, {"lip_b", 0.45f}, {"lip_c", 0.12f}}) {
    const auto found = cage.curves.find(name);
    if (found == cage.curves.end() || found->second.size() != 2 * kLipColumns + 1) {
      table.Refuse(std::string("curve '") + name + "' must have 13 points");
    }
    for (int k = 0; k <= 2 * kLipColumns; ++k) {
      CageTag& tag = cage.tag[found->second[static_cast<std::size_t>(k)]];
      tag.lip_hold = hold;
      tag.upper_lip = k == kLipColumns ? 0.0f : k < kLipColumns ? 1.0f : -1.0f;
      tag.lip_column = static_cast<float>(k < kLipColumns ? k : 2 * kLipColumns - k);
    }
  }
}

}  // namespace

std::uint32_t CagePoint(const Cage& cage, const TableRow& row, std::string_view word) {
  const std::size_t dot = word.find('.');
  if (dot == std::string_view::npos) {
    row.Refuse(fmt::format("'{}' found where x,y,z, CURVE.i or ~ was expected", word));
  }
  const auto& curve = FindCurve(cage, row, word.substr(0, dot));
  const float index = NumberIn(row, word.substr(dot + 1));
  if (index < 0 || index >= static_cast<float>(curve.size()) || index != std::floor(index)) {
    row.Refuse(fmt::format("there is no point '{}'", word));
  }
  return curve[static_cast<std::size_t>(index)];
}

Cage ReadCage(const Table& curves, const Table& patches, const EyeAnatomy& eye,
              const MouthAnatomy& mouth) {
  Cage cage;
  AddMouthCurves(mouth, cage);
  bool lids = false;
  for (const TableRow& row : curves.rows()) {
    if (row.key() != "curve") row.Refuse(fmt::format("unknown word '{}'", row.key()));
    // The outer rings of the lids depend on the curve `orbit`, so they are made once it is known.
    if (!lids && row.Word(1) != "orbit") {
      AddLidCurves(eye, cage);
      lids = true;
    }
    ReadCurveRow(row, cage);
  }
  TieSkinToLips(cage, curves);
  for (const auto& [name, depth] :
       {std::pair{"nostril", 0.4f}, {"nostril_in", 1.0f}, {"nostril_end", 1.0f}}) {
    const auto found = cage.curves.find(name);
    if (found == cage.curves.end()) continue;
    for (const std::uint32_t v : found->second) cage.tag[v].hole = depth;
  }
  for (const TableRow& row : patches.rows()) ReadPatchRow(row, cage);
  Orient(cage, patches);
  return cage;
}

}  // namespace fsm
