#pragma once

#include <concepts>
#include <type_traits>

#include "fsm/rig/head_asset.h"

namespace fsm {

/// The glTF extension with the data of a head that only we need, and its version; no other version
/// is read.
inline constexpr const char* kAssetExtension = "GALATEA_head";
inline constexpr int kAssetVersion = 4;

/// These lists name every member of a head's description once; the writer, the reader and the check
/// of asset files all walk them, so that a new member is one line here. `v` is called as
/// `v("name", object.member)` in the order of the lists, for a const object or one to be filled.
/// Most names are those of the members. Small structs within HeadSurface and RigData are flattened;
/// their members get the struct's name where their own would be ambiguous.

template <typename T, typename U>
concept Like = std::same_as<std::remove_const_t<T>, U>;

template <typename V>
void Members(V& v, Like<HeadSurface::Part> auto& part) {
  v("material", part.material);
  v("first_index", part.first_index);
  v("index_count", part.index_count);
  v("pbr", part.pbr);
  v("two_sided", part.two_sided);
}

template <typename V>
void Members(V& v, Like<ShutLid> auto& lid) {
  v("vertex", lid.vertex);
  v("colour", lid.colour);
  v("weight", lid.weight);
  v("grain_at", lid.grain_at);
  v("grain_light", lid.grain_light);
  v("slide", lid.slide);
}

template <typename V>
void Members(V& v, Like<SkinStroke> auto& stroke) {
  v("root", stroke.root);
  v("middle", stroke.middle);
  v("tip", stroke.tip);
  v("width_mm", stroke.width_mm);
  v("tint", stroke.tint);
}

template <typename V>
void Members(V& v, Like<Strand> auto& strand) {
  v("along", strand.along);
  v("density", strand.density);
  v("across", strand.across);
  v("tile_mm", strand.tile_mm);
}

template <typename V>
void Members(V& v, Like<PbrMaterial> auto& material) {
  v("kind", material.kind);
  v("metallic", material.metallic);
  v("roughness", material.roughness);
  v("emissive", material.emissive);
  v("shade_colour", material.shade_colour);
  v("shade_to", material.shade_to);
  v("light_from", material.light_from);
  v("cut_out", material.cut_out);
}

template <typename V>
void Members(V& v, Like<EyePicture> auto& picture) {
  v("iris", picture.iris);
  v("ball", picture.ball);
}

template <typename V>
void Members(V& v, Like<EyeGeometry> auto& eye) {
  v("ball_radius", eye.ball_radius);
  v("iris_radius", eye.iris_radius);
  v("pupil_radius", eye.pupil_radius);
  v("iris_colour", eye.iris_colour);
  v("white_colour", eye.white_colour);
}

template <typename V>
void Members(V& v, Like<Incisors> auto& incisors) {
  v("upper", incisors.upper);
  v("lower", incisors.lower);
  v("upper_root", incisors.upper_root);
}

template <typename V>
void Members(V& v, Like<MouthVertices> auto& mouth) {
  v("seam", mouth.seam);
  v("corners", mouth.corners);
  v("incisors", mouth.incisors);
}

template <typename V>
void Members(V& v, Like<HeadSurface> auto& surface) {
  v("indices", surface.indices);
  v("parts", surface.parts);
  v("albedo", surface.albedo);
  v("openness", surface.openness);
  v("opacity", surface.opacity);
  v("uv", surface.uv);
  v("skin_strokes", surface.skin_strokes);
  v("strands", surface.strands);
  v("image", surface.textures.base_colour);
  v("pbr_materials", surface.pbr_materials);
  v("normal_map", surface.textures.normal_roughness_metal);
  v("emissive_map", surface.textures.emission_openness);
  v("texcoord", surface.textures.texcoord);
  v("texture_weight", surface.textures.weight);
  v("shut_lids", surface.portrait.shut_lids);
  v("portrait_light", surface.portrait.light);
  v("relit", surface.portrait.relit);
  v("portrait_eyes", surface.portrait.eyes);
  v("saturation", surface.portrait.saturation);
  v("eyes", surface.eyes);
}

template <typename V>
void Members(V& v, Like<SkinWeights> auto& weights) {
  v("domain", weights.domain);
  v("above_mouth", weights.above_mouth);
  v("jaw", weights.jaw);
  v("neck", weights.neck);
  v("free", weights.free);
}

template <typename V>
void Members(V& v, Like<Displacement> auto& displacement) {
  v("vertex", displacement.vertex);
  v("by", displacement.offset);
}

template <typename V>
void Members(V& v, Like<Drive> auto& drive) {
  v("kind", drive.kind);
  v("number", drive.number);
  v("side", drive.side);
  v("half", drive.half);
}

template <typename V>
void Members(V& v, Like<Channel::Driver> auto& driver) {
  v("drive", driver.drive);
  v("gain", driver.gain);
}

template <typename V>
void Members(V& v, Like<Channel> auto& channel) {
  v("drivers", channel.drivers);
  v("min", channel.min);
  v("max", channel.max);
  v("open_factor", channel.open_factor);
  v("sealed_factor", channel.sealed_factor);
  v("moves", channel.moves);
}

template <typename V>
void Members(V& v, Like<GazeRange> auto& range) {
  v("gaze_deg", range.gaze_deg);
  v("output", range.output);
}

template <typename V>
void Members(V& v, Like<GazeRanges> auto& ranges) {
  v("inner", ranges.inner);
  v("outer", ranges.outer);
  v("up", ranges.up);
  v("down", ranges.down);
}

template <typename V>
void Members(V& v, Like<EyeTransform> auto& eye) {
  v("shift", eye.shift);
  v("roll", eye.roll);
  v("size", eye.size);
  v("upper_mm", eye.upper_mm);
  v("lower_mm", eye.lower_mm);
}

template <typename V>
void Members(V& v, Like<LidRig::Vertex> auto& lid) {
  v("vertex", lid.vertex);
  v("side", lid.side);
  v("upper", lid.point.upper);
  v("lower", lid.point.lower);
  v("upper_angle", lid.point.upper_angle);
  v("lower_angle", lid.point.lower_angle);
  v("meet_angle", lid.point.meet_angle);
  v("opening", lid.point.opening);
  v("y", lid.point.y);
  v("z", lid.point.z);
  v("proper", lid.is_lid);
}

template <typename V>
void Members(V& v, Like<LidRig> auto& lids) {
  v("vertices", lids.vertices);
  v("eyes", lids.eyes);
  v("ball", lids.ball);
  v("cornea_centre", lids.cornea_centre);
}

template <typename V>
void Members(V& v, Like<LipRig::Follower> auto& follower) {
  v("vertex", follower.vertex);
  v("pair", follower.pair);
  v("hold", follower.hold);
}

template <typename V>
void Members(V& v, Like<LipRig> auto& lips) {
  v("apart_at_rest", lips.apart_at_rest);
  v("followers", lips.followers);
}

template <typename V>
void Members(V& v, Like<BallLid> auto& lid) {
  v("vertex", lid.vertex);
  v("side", lid.side);
  v("min_radius", lid.min_radius);
}

template <typename V>
void Members(V& v, Like<ToothArch> auto& arch) {
  v("front_z", arch.front_z);
  v("depth", arch.depth);
  v("half_width", arch.half_width);
  v("edge_y", arch.edge_y);
  v("root_y", arch.root_y);
  v("middle_x", arch.middle_x);
  v("slope", arch.slope);
}

template <typename V>
void Members(V& v, Like<TeethRig::Contact> auto& contact) {
  v("vertex", contact.vertex);
  v("upper_gap", contact.upper_gap);
  v("lower_gap", contact.lower_gap);
}

template <typename V>
void Members(V& v, Like<Spring> auto& spring) {
  v("rest", spring.rest);
  v("root", spring.root);
  v("outward", spring.outward);
  v("frequency_hz", spring.frequency_hz);
  v("damping", spring.damping);
  v("hang", spring.hang);
  v("reach_mm", spring.reach_mm);
}

template <typename V>
void Members(V& v, Like<SpringWeight> auto& weight) {
  v("vertex", weight.vertex);
  v("spring", weight.spring);
  v("weight", weight.weight);
}

/// Lists all members except `units`, which are stored as the text of their table.
template <typename V>
void Members(V& v, Like<RigData> auto& rig) {
  v("steps", rig.steps);
  v("rest", rig.rest);
  v("rest_normal", rig.rest_normal);
  v("proxy_rest", rig.proxy.rest);
  v("proxy_to_own", rig.proxy.to_own);
  v("bone", rig.bone);
  v("weights", rig.weights);
  v("soft_triangles", rig.normals.soft_triangles);
  v("normal_twin", rig.normals.twin);
  v("mouth", rig.mouth);
  v("asymmetry_seed", rig.asymmetry_seed);
  v("units_by_place", rig.has_unit_channels);
  v("channels", rig.channels);
  v("lids", rig.lids);
  v("ball_lids", rig.ball_lids);
  v("lips", rig.lips);
  v("upper_teeth", rig.teeth.upper);
  v("lower_teeth", rig.teeth.lower);
  v("teeth_contacts", rig.teeth.contacts);
  v("jaw_hinge", rig.jaw.hinge);
  v("chin", rig.jaw.chin);
  v("eye_centre", rig.eyes.centre);
  v("eye_pivot", rig.eyes.pivot);
  v("gaze_ranges", rig.eyes.gaze_ranges);
  v("creases", rig.creases.at_rest);
  v("crease_depth", rig.creases.depth);
  v("springs", rig.spring_rig.springs);
  v("spring_weights", rig.spring_rig.weights);
}

template <typename V>
void Members(V& v, Like<ParallelView> auto& view) {
  v("centre", view.centre);
  v("half_mm", view.half_mm);
}

/// Types of which a file stores one column for each member, not one object for each element.
template <typename T>
concept Tabular =
    Like<T, SkinStroke> || Like<T, ShutLid> || Like<T, Strand> || Like<T, SkinWeights> ||
    Like<T, Displacement> || Like<T, LidRig::Vertex> || Like<T, LipRig::Follower> ||
    Like<T, BallLid> || Like<T, TeethRig::Contact> || Like<T, Spring> || Like<T, SpringWeight>;

}  // namespace fsm
