/* tier: quick */
/* Mutated glTF files, the same in every run: flipped bits, extreme numbers, pieces that are cut, doubled and moved. The sanitizers check.
 * ECLAT_FUZZ_RUNS and ECLAT_FUZZ_SEED change number and kind. */
#include "test_scene_files.h"

#include <sys/stat.h>

typedef struct seed_file {
    unsigned char *bytes;
    size_t size;
} seed_file;

enum { MAX_SEEDS = 16, MAX_SEED_SIZE = 200000 };
static seed_file seeds[MAX_SEEDS];
static int seed_count;
static uint64_t state;

static uint32_t random_below(uint32_t n) /* the high bits of a plain LCG suffice */
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((state >> 33) % (n ? n : 1));
}

static const char everything[] =
    "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_lights_punctual','KHR_texture_transform'],'scene':0,"
    "'scenes':[{'nodes':[0,2,3]}],'nodes':[{'mesh':0,'scale':[1,-2,3],'children':[1]},{'mesh':0,'rotation':[0,0,1,0]},"
    "{'camera':0,'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]},{'extensions':{'KHR_lights_punctual':{'light':0}}}],"
    "'cameras':[{'type':'perspective','perspective':{'yfov':0.5,'znear':0.1}}],"
    "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','spot':{'outerConeAngle':0.5}}]}},"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'indices':2,'material':0,'mode':5}]}],"
    "'buffers':[{'byteLength':36,'uri':'@pos@'},{'byteLength':24,'uri':'@uv@'}],"
    "'bufferViews':[{'buffer':0,'byteLength':36,'byteStride':12},{'buffer':1,'byteLength':24},{'buffer':1,'byteLength':8}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':1,'indices':"
    "{'bufferView':2,'componentType':5121},'values':{'bufferView':0,'byteOffset':12}}},"
    "{'bufferView':1,'componentType':5126,'count':3,'type':'VEC2'},"
    "{'bufferView':1,'byteOffset':4,'componentType':5121,'count':4,'type':'SCALAR'}],"
    "'images':[{'uri':'@png@'},{'bufferView':1,'mimeType':'image/png'}],'samplers':[{'magFilter':9728,'wrapS':33071}],"
    "'textures':[{'source':0,'sampler':0},{'source':1}],'materials':[{'name':'m','alphaMode':'MASK',"
    "'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'extensions':{'KHR_texture_transform':{'offset':[0.5,1],"
    "'rotation':2,'scale':[2,3],'texCoord':0}}}},'emissiveTexture':{'index':1},'emissiveFactor':[1,2,3],"
    "'extensions':{'KHR_materials_specular':{'specularFactor':0.5,'specularColorTexture':{'index':0}}}}]}";

static void add_seed(const void *bytes, size_t size)
{
    if (!size || size > MAX_SEED_SIZE || seed_count == MAX_SEEDS) return;
    seeds[seed_count].bytes = memcpy(malloc(size), bytes, size);
    seeds[seed_count++].size = size;
}

static void add_seed_file(const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, ECLAT_SHARED "/assets/%s", name);
    FILE *file = fopen(path, "rb");
    if (!file) return;
    unsigned char *bytes = malloc(MAX_SEED_SIZE + 1);
    add_seed(bytes, fread(bytes, 1, MAX_SEED_SIZE + 1, file));
    free(bytes);
    fclose(file);
}

static void add_everything(void)
{
    const float uv[6] = {0, 0, 1, 0, 0, 1};
    char *text = from_single_quotes(everything);
    const blob blobs[] = {{"@pos@", triangle_positions, 36}, {"@uv@", uv, 24}, {"@png@", uv, 24}};
    for (int i = 0; i < 3; i++) {
        char *uri = data_uri(blobs[i].bytes, blobs[i].size), *next = replace(text, blobs[i].mark, uri);
        free(uri);
        free(text);
        text = next;
    }
    add_seed(text, strlen(text));
    free(text);
}

/* Replaces one number of the JSON, chosen at random, by another. */
static size_t swap_number(unsigned char *bytes, size_t size)
{
    static const char *const awkward[] = {"0", "1", "2", "3", "-1", "255", "5121", "5126", "65535", "2147483647", "2147483648",
                                          "4294967295", "9007199254740992", "18446744073709551615", "1e38", "-1e38",
                                          "1e-45", "1e308", "0.5", "null", "[]", "{}", "\"x\"", "true"};
    size_t at = random_below((uint32_t)size);
    while (at < size && !((bytes[at] >= '0' && bytes[at] <= '9') && at && strchr(":,[ ", bytes[at - 1]))) at++;
    if (at >= size) return size;
    size_t end = at;
    while (end < size && bytes[end] && strchr("0123456789.eE+-", bytes[end])) end++;
    const char *by = awkward[random_below(sizeof awkward / sizeof *awkward)];
    size_t length = strlen(by);
    memmove(bytes + at + length, bytes + end, size - end);
    memcpy(bytes + at, by, length);
    return size - (end - at) + length;
}

static size_t mutate(unsigned char *bytes, size_t size)
{
    uint32_t at = random_below((uint32_t)size), length = random_below(40) + 1;
    if (length > size - at) length = (uint32_t)(size - at);
    switch (random_below(8)) {
    case 0: bytes[at] ^= (unsigned char)(1u << random_below(8)); return size;
    case 1: bytes[at] = (unsigned char)random_below(256); return size;
    case 2: memmove(bytes + at, bytes + at + length, size - at - length); return size - length;
    case 3: memmove(bytes + at + length, bytes + at, size - at); return size + length;
    case 4: return at ? at : 1;
    default: return swap_number(bytes, size);
    }
}

static void run(int count)
{
    unsigned char *bytes = malloc(MAX_SEED_SIZE * 2);
    ec_error err;
    int loaded = 0;
    for (int i = 0; i < count; i++) {
        const seed_file *seed = &seeds[random_below((uint32_t)seed_count)];
        size_t size = seed->size;
        memcpy(bytes, seed->bytes, size);
        for (uint32_t k = random_below(4) + 1; k; k--) size = mutate(bytes, size);
        write_file(ECLAT_TEST_OUT "/fuzz-last.gltf", bytes, size); /* stays after a crash */
        ec_scene *scene = load_bytes(bytes, size, ".gltf", &err);
        loaded += scene != NULL;
        ec_scene_free(scene);
    }
    printf("%d mutants of %d seeds, %d still load\n", count, seed_count, loaded);
    remove(ECLAT_TEST_OUT "/fuzz-last.gltf");
    free(bytes);
}

int main(void)
{
    const char *runs = getenv("ECLAT_FUZZ_RUNS"), *start = getenv("ECLAT_FUZZ_SEED");
    state = start ? (uint64_t)atoll(start) : 1;
    add_everything();
    add_seed_file("bad-gltf/cgltf-fuzz/data/Box.glb");
    add_seed_file("bad-gltf/cgltf-fuzz/data/TriangleWithoutIndices.gltf");
    add_seed_file("bad-gltf/cgltf-fuzz/data/WaterBottle.gltf");
    add_seed_file("gltf/SimpleSparseAccessor/glTF-Embedded/SimpleSparseAccessor.gltf");
    add_seed_file("gltf/Cameras/glTF-Embedded/Cameras.gltf");
    add_seed_file("gltf/BoxTextured/glTF-Binary/BoxTextured.glb");
    add_seed_file("gltf/BoxVertexColors/glTF-Binary/BoxVertexColors.glb");
    add_seed_file("gltf/VertexColorTest/glTF-Binary/VertexColorTest.glb");
    add_seed_file("gltf/NegativeScaleTest/glTF-Binary/NegativeScaleTest.glb");
    add_seed_file("gltf/TextureCoordinateTest/glTF-Binary/TextureCoordinateTest.glb");
    run(runs ? atoi(runs) : 1500);
    for (int i = 0; i < seed_count; i++) free(seeds[i].bytes);
    TEST_END();
}
