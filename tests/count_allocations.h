// Counts what a thread takes from the heap: malloc and its family are replaced in the programs that
// link test_support and name `allocations`.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SPOOLWATCH_COUNTS_MALLOC 0  // the sanitizers bring their own malloc
#else
#define SPOOLWATCH_COUNTS_MALLOC 1
#endif

extern constinit thread_local long allocations;  ///< by this thread
