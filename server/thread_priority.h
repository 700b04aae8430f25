#pragma once

namespace weft::server {

/// Makes the calling thread one that is served soon after it wakes: others that run are interrupted
/// for it, also after a fraction of the time that Linux lets them go on. For threads that sleep
/// until something is due. It gets no larger share of the time by it. Does nothing before Linux
/// 6.12, whose scheduler of then interrupts for all that slept.
void be_prompt();

}  // namespace weft::server
