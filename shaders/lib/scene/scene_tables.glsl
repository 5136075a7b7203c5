// The shared set 3: the scene as compute shaders look it up at hits.
#ifndef HELIOGRAPH_SCENE_TABLES_GLSL
#define HELIOGRAPH_SCENE_TABLES_GLSL
#include "shared/emissive.h"
#include "shared/scene.h"
#include "shared/texture_heap.h"

layout(set = 3, binding = 0, std430) readonly buffer Vertices { Vertex vertices[]; };
layout(set = 3, binding = 1, std430) readonly buffer Indices { uint indices[]; };
layout(set = 3, binding = 2, std430) readonly buffer Meshes { Mesh meshes[]; };
layout(set = 3, binding = 3, std430) readonly buffer Instances { Instance instances[]; };
layout(set = 3, binding = 4, std430) readonly buffer Materials { Material materials[]; };
layout(set = 3, binding = 5, std430) readonly buffer Textures { HeapTexture textures[]; };
layout(set = 3, binding = 6) uniform usamplerBuffer texture_heap;
layout(set = 3, binding = 7, std430) readonly buffer Layers { MaterialLayer layers[]; };
layout(set = 3, binding = 8, std430) readonly buffer EmissiveTable {
  EmissiveHeader emissive_header;
  EmissiveTriangle emissive_triangles[];
};
layout(set = 3, binding = 9, std430) readonly buffer EmissiveFirst { uint emissive_first[]; };

#endif
