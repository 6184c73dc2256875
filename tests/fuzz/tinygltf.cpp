// tinygltf once more, so that the sanitizers and the fuzzer see into it.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
