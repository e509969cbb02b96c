// Is this program built with the address sanitizer? It owns the allocator and needs most of the address space.
#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define FREEPLAY_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FREEPLAY_ADDRESS_SANITIZER 1
#endif
#endif
#ifndef FREEPLAY_ADDRESS_SANITIZER
#define FREEPLAY_ADDRESS_SANITIZER 0
#endif
