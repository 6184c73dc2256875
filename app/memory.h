// Whether there is memory for what a command is about to do: asked before the work, not found out in it.
#pragma once

#include <cstdint>
#include <string>

namespace ltcfit::app {

/// Bytes that this process can still take: the least of what the machine has free, what its cgroup (v1 or
/// v2) leaves, and what its limit of address space leaves. The largest number where none of them is told.
std::uint64_t availableMemory();

/// Throws InputError unless `bytes`, an estimate of the memory that a command will take, are available. The
/// message is "`what` take about BYTES, AVAILABLE are free: `advice`".
void requireMemory(double bytes, const std::string& what, const std::string& advice);

}  // namespace ltcfit::app
