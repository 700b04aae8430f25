#pragma once

#include <cstddef>
#include <cstdint>

// The numbers that the server assumes about work, time and viewers. Ranges of options stand in
// options.h, those of commands in proto/limits.h.

namespace weft::server {

// What work may cost.

/// Share of a tick's limit that work between two ticks may take [1]: 0.8 s with the default limit,
/// so that no command waits a second for it. Larger: commands wait longer. Smaller: queries for the
/// contacts of large scenes are refused.
inline constexpr double kBetweenTicks = 0.4;

/// Longest mesh message [bytes], which each new viewer is sent: 9 s at 30 Mbit/s. All cloth of
/// the largest scene takes 18 MB. Larger: joining a scene of many meshes takes longer. Smaller:
/// fine meshes are refused.
inline constexpr std::size_t kMostMeshBytes = std::size_t{32} << 20U;

/// Contacts and reactions that a query asked for are measured in so many further ticks, after which
/// the next query looks one tick ahead again. More: ticks are dearer for longer after a single
/// question. Fewer: who asks now and then pays for a tick each time.
inline constexpr std::uint64_t kForcesAskedTicks = 600;

/// Commands of one turn may take this long before the next tick [s]. Larger: a crowd of commands
/// delays ticks. Smaller: it waits for more of them.
inline constexpr double kOrderSlice = 0.1;

/// A hand of a viewer that is no operator holds at most one part in kHoldsBeside of the particles
/// of a cloth that it shares, or kNarrowHold of them if that is more. Larger part: one hand takes
/// the cloth from all others. Smaller: to hold much of it takes several hands.
inline constexpr std::size_t kHoldsBeside = 4, kNarrowHold = 64;

/// A cheaper command than this costs its viewer nothing [s of CPU]. After a more expensive one its
/// viewer waits kWaitPerCost times as long before its next, if other viewers are present, here or
/// in another room. Larger: one viewer can keep others waiting. Smaller: scripts that ask much are
/// held up.
inline constexpr double kFreeCost = 2e-3, kWaitPerCost = 3;

/// A viewer waits this long after its `load` [s], because the new scene is sent to all. Larger: a
/// script that loads scene after scene is slow. Smaller: it keeps others busy with meshes.
inline constexpr double kPauseAfterLoad = 0.25;

// Who may what.

/// Viewers of a room that others reach, up to which newcomers may hold the cloth at once [1]. More:
/// strangers can spoil it together. Fewer: two people and their scripts have to ask each other.
inline constexpr std::size_t kMostUnasked = 3;

/// Time between two changes of a viewer's name [s], of which all viewers are told. Larger: names
/// follow later. Smaller: one viewer makes the server tell all others more often.
inline constexpr double kNamePause = 1;

/// Viewers of whose cursors and cameras one message tells [1]. More: a crowd's messages are longer
/// and rarer. Fewer: a cursor in a crowd moves less often.
inline constexpr std::size_t kMostPresences = 8;

/// Shortest time between two such messages [s], and their sustained rate to one viewer [bytes/s].
/// Larger pause: cursors jump. Larger rate: many hands cost slow links more.
inline constexpr double kPresencePause = 0.1, kPresenceRate = 4000;

// Time.

/// Longest sleep of the simulation thread [s]. Larger: leases end later. Smaller: an idle room
/// costs more.
inline constexpr double kLongestSleep = 0.25;

/// Idle time after which a room counts crossings once [s]. Larger: a paused room tells them later.
/// Smaller: single steps are counted each.
inline constexpr double kStandingPause = 0.25;

/// Ticks of which the median is told. More: it follows a change later. Fewer: it wavers.
inline constexpr std::size_t kTickTimes = 120;

/// Fraction of the wanted speed below which time passes slowly [1], how long it has to until that
/// is told, and until it is told again [s]. Larger: less is told, and later.
inline constexpr double kSlow = 0.9, kSlowPatience = 2, kSlowNoticePause = 10;

// Rooms.

/// Ticks that take less CPU than this count as light, however many rooms there are [s]. Larger: a
/// few rooms delay the others' ticks. Smaller: rooms change their threads for nothing.
inline constexpr double kShortTick = 2e-3;

/// Weight of a tick in the mean by which a room counts as light or heavy [1]. Larger: a single long
/// tick decides. Smaller: a room that overruns delays others for longer.
inline constexpr double kCostMemory = 0.2;

/// How long before light rooms are due heavy ones give way to them [s]. Larger: processors stand
/// idle. Smaller: ticks of light rooms begin late, as a turn looks only at its stop points.
inline constexpr double kWayAhead = 0.5e-3;

/// For how long a heavy room gives way in a row [s]. Larger: it stands where light ones leave
/// nothing. Smaller: it delays them more often.
inline constexpr double kLongestWay = 20e-3;

/// For how long it then goes on, whatever is due [s]: by so much light ones are late at most.
inline constexpr double kLeastRun = 1e-3;

/// For how long a thread that serves light rooms or the network runs before others have their turn
/// [ns]; the shorter, the sooner it is served when it wakes. Linux allows 1e5 to 1e8.
inline constexpr unsigned long long kPromptSlice = 100'000;

/// Threads that build scenes. More: memory and time that ticks lack. Fewer: a load waits for
/// other loads.
inline constexpr int kSceneBuilders = 2;

/// Particles of all rooms together, and updates of particles by their solvers a simulated second:
/// twice what one room may have. Larger: memory. Smaller: fewer rooms of fine cloth.
inline constexpr double kMostParticlesOfRooms = 600'000, kMostUpdatesOfRooms = 2e10;

/// States that a room keeps for `restore`, and particles of all of them together. More: memory,
/// 1 to 3 kB a particle. Fewer: scripts that go back to several states load and advance instead.
inline constexpr std::size_t kMostSaves = 16, kMostSavedParticles = 300'000;

/// Entries of its room's log that a fork keeps. More: memory of each fork, about 200 bytes an
/// entry. Fewer: the logs of forks of old rooms tell less of the history.
inline constexpr std::size_t kForkedLog = 4096;

/// A turn that lasts longer, or has been due for longer, is told in `/readyz` [s]. Larger: it is
/// told later. Smaller: scenes with long ticks are told.
inline constexpr double kStallSeconds = 1;

// What viewers are told, and how often.

/// Time between two `state` while ticks pass [s]. Larger: figures lag. Smaller: more messages.
inline constexpr double kStatePause = 0.25;

/// Shortest time between two announcements of changes [s]. Larger: changes are told later at high
/// tick rates. Smaller: more messages.
inline constexpr double kShortestTelling = 1.0 / 240;

/// Sustained rate of announcements to one viewer [bytes/s]. Larger: one viewer's pins can fill
/// another one's queue. Smaller: long lists are told late.
inline constexpr double kTellingRate = 2e6;

/// Frames of an `advance` that its viewer has not taken, beyond which its ticks wait. More: memory.
/// Fewer: the ticks wait for each round trip.
inline constexpr long kMostFramesInFlight = 4;

/// Time without a taken frame after which the viewer of an `advance` counts as not reading [s].
/// Larger: it holds up the room for longer. Smaller: a slow link ends it.
inline constexpr double kStalled = 2;

}  // namespace weft::server
