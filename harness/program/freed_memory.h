// What the C library does with memory that is given back.
#pragma once

namespace waretwin {

// From now on the process keeps it. For work that asks for the same large blocks again and again, picture by picture or step by step: by
// default they go back to the system, which hands them out page by page, cleared.
void keep_freed_memory();

}  // namespace waretwin
