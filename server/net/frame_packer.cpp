#include "server/net/frame_packer.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <span>

namespace weft::server {
namespace {

using proto::FrameFields;

std::span<const std::byte> bytes_of(const SharedBytes& frame) {
  return {static_cast<const std::byte*>(frame.data()), frame.size()};
}

/// Positions of a float32 frame: they are its first section.
std::vector<float> positions_in(std::span<const std::byte> frame, std::uint32_t vertices) {
  const std::size_t begin = proto::kFrameBytes + proto::kSectionHeaderBytes;
  std::vector<float> positions(3 * std::size_t{vertices});
  assert(frame.size() >= begin + positions.size() * sizeof(float));
  if (!positions.empty())
    std::memcpy(positions.data(), frame.data() + begin, positions.size() * sizeof(float));
  return positions;
}

}  // namespace

void FramePacker::begin(const PackedMesh& mesh) {
  mesh_ = mesh;
  tracks_.clear();
}

std::size_t FramePacker::kept_frames() const {
  std::size_t kept = 0;
  for (const auto& [error, track] : tracks_) kept += track.kept.size();
  return kept;
}

SharedBytes FramePacker::pack(const SharedBytes& frame, PackedStream& stream) {
  if (stream.error <= 0 || frame.size() < proto::kFrameBytes) return frame;
  // What a script observes is told to the bit.
  const auto flags = proto::read_at<proto::BinaryHeader>(bytes_of(frame), 0).flags;
  if ((flags & proto::kFrameObserved) != 0) return frame;
  const auto fields = proto::read_at<FrameFields>(bytes_of(frame), proto::kCommonBytes);
  const bool fits =
      mesh_.order && fields.epoch == mesh_.epoch && fields.vertices == mesh_.order->size();
  Track& track = tracks_[stream.error];
  Kept* const now = fits ? keep(track, frame, stream.error) : nullptr;
  if (!now) {
    stream.held = 0;
    return frame;
  }
  Kept* last = reference(track, *now, stream);
  Kept* before = last && stream.held > 1 ? find(track, stream.before) : nullptr;
  // The line through both leads to this frame only if the three are evenly spaced.
  if (before && (before->tick >= last->tick || 2 * last->tick != before->tick + now->tick))
    before = nullptr;
  Encoding& encoding = encode(track, *now, last, before);
  const bool key = !encoding.last;
  const auto made = std::find_if(encoding.messages.begin(), encoding.messages.end(),
                                 [&](const auto& m) { return m.first == frame.size(); });
  stream.before = stream.last;
  stream.held = key ? 1 : std::min(stream.held + 1, 2);
  stream.generation = now->generation;
  if (made != encoding.messages.end()) {
    stream.last = now->sequence;
    return made->second;
  }
  const proto::codec::PackedFields packed{key ? now->sequence : stream.last, track.lattice->step};
  stream.last = now->sequence;
  SharedBytes message(proto::codec::pack_frame(bytes_of(frame), packed, encoding.payload));
  encoding.messages.emplace_back(frame.size(), message);
  return message;
}

/// The frame in whole numbers; null if the bound cannot be kept. A new lattice starts where the old
/// one does not hold all positions.
FramePacker::Kept* FramePacker::keep(Track& track, const SharedBytes& frame, double error) {
  const auto fields = proto::read_at<FrameFields>(bytes_of(frame), proto::kCommonBytes);
  if (Kept* const known = find(track, fields.sequence)) return known;
  const std::vector<float> positions = positions_in(bytes_of(frame), fields.vertices);
  const proto::codec::Bounds bounds = proto::codec::bounds_of(positions);
  if (!track.lattice || !holds(*track.lattice, bounds)) {
    track.lattice = make_lattice(bounds, error, track.lattice ? track.lattice->reach : 0);
    track.generation = ++generations_;
    track.kept.clear();
  }
  if (!track.lattice) return nullptr;
  // A frame is forgotten after the one that takes its place, which then costs no memory anew.
  std::unique_ptr<Kept> kept = std::make_unique<Kept>();
  if (track.kept.size() >= kKeptFrames) {
    kept->integers = std::move(track.kept.front()->integers);
    track.kept.pop_front();
  }
  const auto flags = proto::read_at<proto::BinaryHeader>(bytes_of(frame), 0).flags;
  kept->sequence = fields.sequence;
  kept->generation = track.generation;
  kept->tick = fields.tick;
  kept->jump = (flags & proto::kFrameJump) != 0;
  quantise(*track.lattice, positions, mesh_.order->vertices, kept->integers);
  return track.kept.emplace_back(std::move(kept)).get();
}

FramePacker::Kept* FramePacker::find(Track& track, std::uint32_t sequence) {
  const auto found = std::find_if(track.kept.rbegin(), track.kept.rend(),
                                  [=](const auto& kept) { return kept->sequence == sequence; });
  return found == track.kept.rend() ? nullptr : found->get();
}

/// The viewer's last frame, if this one can build on it; else null.
FramePacker::Kept* FramePacker::reference(Track& track, const Kept& now,
                                          const PackedStream& stream) {
  if (stream.held == 0 || stream.generation != now.generation || now.jump) return nullptr;
  Kept* const last = find(track, stream.last);
  if (!last || last == &now || last->tick > now.tick || now.tick - last->tick > kOldest)
    return nullptr;
  return last;
}

std::optional<std::uint32_t> FramePacker::sequence_of(const Kept* kept) {
  return kept ? std::optional(kept->sequence) : std::nullopt;
}

FramePacker::Encoding& FramePacker::encode(Track& track, Kept& now, Kept* last, Kept* before) {
  const auto found = [&]() -> Encoding* {
    for (Encoding& encoding : now.encodings)
      if (encoding.last == sequence_of(last) && encoding.before == sequence_of(before))
        return &encoding;
    return nullptr;
  };
  if (Encoding* const known = found()) return *known;
  // So many viewers of different histories share the key, which needs none.
  if (last && now.encodings.size() >= kMostEncodings) {
    last = before = nullptr;
    if (Encoding* const known = found()) return *known;
  }
  proto::codec::PackRequest request;
  request.references = {last ? &last->integers : nullptr, before ? &before->integers : nullptr};
  request.before = before ? before->sequence : 0;
  ++encodings_;
  Encoding& encoding = now.encodings.emplace_back();
  encoding.last = sequence_of(last);
  encoding.before = sequence_of(before);
  encoding.payload = encoder_.encode(*mesh_.order, *track.lattice, now.integers, request);
  return encoding;
}

}  // namespace weft::server
