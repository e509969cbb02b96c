// Probe: a shared library without the entry point.
extern "C" __attribute__((visibility("default"))) int freeplay_plugin_v0() { return 0; }
