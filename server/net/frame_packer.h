#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "proto/frames/packed_frame.h"
#include "server/message.h"

namespace weft::server {

/// What one viewer wants of packed frames, and which ones it holds. All that is kept for it.
struct PackedStream {
  double error = 0;              ///< bound [m]; 0: wants float32
  std::uint32_t generation = 0;  ///< lattice of the frames that it holds
  std::uint32_t last = 0;        ///< sequence of the last frame sent
  std::uint32_t before = 0;      ///< and of the one before
  int held = 0;                  ///< how many of the two there are
};

/// Packs frames at the moment in which they are sent, when it is known on which ones they can
/// build. Viewers with the same bound that hold the same frames share an encoding. Lives on the
/// network thread.
class FramePacker {
 public:
  static constexpr std::uint64_t kOldest = 8;       ///< age of a reference [ticks]
  static constexpr std::size_t kKeptFrames = 17;    ///< of each bound
  static constexpr std::size_t kMostEncodings = 4;  ///< of a frame and bound, beside its key

  /// A new mesh: no frame builds on one of the last.
  void begin(const PackedMesh& mesh);

  /// The bytes to send in place of a float32 frame, given what the viewer holds; updates that. The
  /// same bytes if the frame cannot be packed within the bound, or is of another mesh.
  SharedBytes pack(const SharedBytes& frame, PackedStream& stream);

  /// Forgets all frames; for when no viewer wants packed ones.
  void forget() { tracks_.clear(); }

  std::uint64_t encodings() const { return encodings_; }
  std::size_t kept_frames() const;

 private:
  /// A frame as it is coded on top of two others, or of none.
  struct Encoding {
    std::optional<std::uint32_t> last, before;  // their sequences
    proto::Bytes payload;
    std::vector<std::pair<std::size_t, SharedBytes>> messages;  // by the length of the float32 one
  };
  /// A frame that was sent, in whole numbers.
  struct Kept {
    std::uint32_t sequence = 0, generation = 0;
    std::uint64_t tick = 0;
    bool jump = false;
    proto::codec::Integers integers;
    std::deque<Encoding> encodings;
  };
  /// All frames of one bound.
  struct Track {
    std::optional<proto::codec::Lattice> lattice;
    std::uint32_t generation = 0;
    std::deque<std::unique_ptr<Kept>> kept;
  };

  Kept* keep(Track& track, const SharedBytes& frame, double error);
  static std::optional<std::uint32_t> sequence_of(const Kept* kept);
  static Kept* find(Track& track, std::uint32_t sequence);
  static Kept* reference(Track& track, const Kept& now, const PackedStream& stream);
  Encoding& encode(Track& track, Kept& now, Kept* last, Kept* before);

  PackedMesh mesh_;
  std::map<double, Track> tracks_;  // by bound; there are few
  std::uint32_t generations_ = 0;
  proto::codec::PayloadEncoder encoder_;
  std::uint64_t encodings_ = 0;
};

}  // namespace weft::server
