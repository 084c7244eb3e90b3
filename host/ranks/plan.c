#include "ranks/plan.h"

#include <math.h>

#include "film/parts.h"
#include "render/team.h"
#include "ranks/transport.h"
#include "report/format.h"
#include "report/json.h"

static double bytes_per_second(const ec_plan *p) { return p->gbit * 1e9 / 8; }
static double latency(const ec_plan *p) { return p->microseconds * 1e-6; }

#define IDLE_SECONDS 2e-3  /* between two pieces of a rank: both threads check for messages every millisecond */

static const char *largest_loss(double start, double messages, double end, double link, double sums)
{
    const double losses[] = {start, messages, end, link, sums};
    static const char *const names[] = {"start", "messages between pieces", "the last pieces, which cannot be smaller",
                                        "rank 0's link", "rank 0's sums"};
    int most = 0;
    for (int i = 1; i < 5; i++)
        if (losses[i] > losses[most]) most = i;
    return names[most];
}

/* How many batches arrive singly, in blocks of EC_FILM_FIRST, and in blocks of 16 times that. */
static double block_size(int level) { return EC_FILM_FIRST * pow(EC_FILM_RADIX, level - 1); }

typedef struct mixture {
    double count[3];
    double largest;           /* batches in the largest unit */
} mixture;

/* Chooses blocks as render/team_pieces.c does: none within the first batches, before they are aligned, and none towards the end, where pieces have to
 * be small. */
static mixture mixture_of(const ec_plan *p, uint32_t ranks)
{
    mixture m = {.largest = 1};
    double left = p->batches;
    for (int i = 2; i > 0 && ranks > 1; i--) {
        const double block = block_size(i), least = block * p->batch * fmin(1, (double)p->least / (double)p->pixels);
        const double unit = block * p->batch / ranks, over = unit + fmax(fmin(unit * ranks, EC_TEAM_PIECE_SECONDS), least);
        const double kept_back = block + 2 * least * ranks / p->batch;
        const double share = over <= EC_TEAM_PATIENCE_SECONDS ? 1 : 1 - over / EC_TEAM_PATIENCE_SHARE / (p->batches * p->batch / ranks); /* share of the job */
        if (share <= 0 || left - kept_back < block) continue;
        m.count[i] = (left - kept_back) * share;
        left -= m.count[i];
        m.largest = fmax(m.largest, block);
    }
    m.count[0] = left;
    return m;
}

/* Returns the time to send the scene down the tree of ranks, in parts that are passed on while the next ones arrive: it depends on how many copies
 * one rank sends. */
static double spread_seconds(const ec_plan *p, uint32_t ranks)
{
    const double copies = fmin(EC_TREE_FANOUT, ranks - 1), part = fmin((double)p->scene_bytes, EC_SPREAD_BYTES);
    const double levels = ceil(log(ranks * (EC_TREE_FANOUT - 1.0) + 1) / log(EC_TREE_FANOUT) - 1 - 1e-9);
    return (copies * (double)p->scene_bytes + fmax(levels - 1, 0) * copies * part) / bytes_per_second(p) + levels * latency(p);
}

/* Predicts a row. Batches are cut into pieces, which ranks request one after the other. All but rank 0's own arrive through its link and are added
 * there while others render: the slower of both decides. */
ec_plan_row ec_plan_for(const ec_plan *p, uint32_t ranks)
{
    const bool alone = ranks == 1;
    const double n = p->batches, pixels = (double)p->pixels, work = n * p->batch / ranks, a_byte = 1 / bytes_per_second(p);
    const mixture m = mixture_of(p, ranks);
    const double blocks = m.count[1] / block_size(1) + m.count[2] / block_size(2);
    const double bytes = pixels * ((double)ec_batch_bytes(p->feature_sets) * m.count[0] + (double)ec_sums_bytes(p->replicates, p->feature_sets) * blocks);
    const double piece = fmin(EC_TEAM_PIECE_SECONDS, m.largest * p->batch),
                 idle = alone ? 0 : IDLE_SECONDS + 2 * latency(p) + bytes / n * piece / p->batch * a_byte;
    const double messages = work * idle / piece, end = alone ? 0 : p->batch * fmin(1, (double)p->least / pixels) + idle;
    const double link = bytes * (1 - 1.0 / ranks) * a_byte,
                 sums = alone ? 0 : m.count[0] * p->add + blocks * p->add_block, intake = fmax(link, sums);
    ec_plan_row row = {.ranks = ranks, .load = p->load, .render = work + messages + end, .received = bytes * (1 - 1.0 / ranks)};
    row.send = p->start + spread_seconds(p, ranks);
    row.wait = fmax(intake - row.render, 0) + (alone ? 0 : p->add);
    row.seconds = row.load + row.send + row.render + row.wait;
    row.efficiency = (p->load + p->start + n * p->batch) / (ranks * row.seconds);
    row.held_by = row.efficiency > 0.95 ? "" : largest_loss((row.load + row.send) * (1 - 1.0 / ranks), messages, end, link > sums ? row.wait : 0,
                                                            link > sums ? 0 : row.wait);
    return row;
}

static uint32_t next_count(const ec_plan *p, uint32_t ranks)
{
    return ranks == p->ranks ? 0 : ranks < p->ranks / 2 + p->ranks % 2 ? 2 * ranks : p->ranks;
}

void ec_plan_text(const ec_plan *p, const char *device, FILE *to)
{
    fprintf(to, "job         %.0f batches of %.3g samples a pixel%s, %llu pixels\n", p->batches, p->samples,
            p->batches_predicted ? " (predicted)" : "", (unsigned long long)p->pixels);
    fprintf(to, "measured    scene %.3g s, kernels %.3g s, a batch %.3g s, adding one up %.3g s, a block %.3g s, on %s\n", p->load, p->start,
            p->batch, p->add,
            p->add_block, device);
    fprintf(to, "sent        scene: %s to each rank, along a tree with %d branches; sums to rank 0: %s a batch, or %s a block of %u or %u\n",
            ec_bytes(p->scene_bytes).text, EC_TREE_FANOUT, ec_bytes(ec_batch_bytes(p->feature_sets) * p->pixels).text,
            ec_bytes(ec_sums_bytes(p->replicates, p->feature_sets) * p->pixels).text, EC_FILM_FIRST, EC_FILM_FIRST * EC_FILM_RADIX);
    fprintf(
        to,
        "assumed     %g Gbit/s, %g us a message (--plan RANKS,GBIT,US); all ranks as fast as this one, started at once;\n"
        "            pieces of up to %g s, of %llu pixels at least, %g ms between two of them; blocks where they take all ranks\n"
        "            up to %g s, or %g %% of the time so far, with their last piece, not at the beginning and the end;\n"
        "            writing the picture left out\n\n",
        p->gbit, p->microseconds, EC_TEAM_PIECE_SECONDS, (unsigned long long)p->least, 1e3 * IDLE_SECONDS,
        EC_TEAM_PATIENCE_SECONDS, 100 * EC_TEAM_PATIENCE_SHARE);
    fprintf(to, "%8s %10s %9s %11s %10s   %s\n", "ranks", "seconds", "speed-up", "efficiency", "sums", "held back by");
    const double alone = ec_plan_for(p, 1).seconds;
    for (uint32_t ranks = 1; ranks; ranks = next_count(p, ranks)) {
        const ec_plan_row row = ec_plan_for(p, ranks);
        fprintf(to, "%8u %10.4g %9.4g %9.0f %% %10s   %s\n", ranks, row.seconds, alone / row.seconds,
                100 * row.efficiency, ec_bytes((uint64_t)row.received).text, row.held_by);
    }
}

ec_result ec_plan_json(const ec_plan *p, FILE *to, ec_error *err)
{
    cJSON *root = cJSON_CreateObject(), *rows = cJSON_AddArrayToObject(root, "plan");
    ec_json_real(root, "load_seconds", p->load);
    ec_json_real(root, "kernel_seconds", p->start);
    ec_json_real(root, "batch_seconds", p->batch);
    ec_json_real(root, "add_seconds", p->add);
    ec_json_real(root, "add_block_seconds", p->add_block);
    ec_json_whole(root, "scene_bytes", p->scene_bytes);
    ec_json_whole(root, "batch_bytes", ec_batch_bytes(p->feature_sets) * p->pixels);
    ec_json_real(root, "batches", p->batches);
    ec_json_real(root, "gbit_per_second", p->gbit);
    ec_json_real(root, "message_microseconds", p->microseconds);
    for (uint32_t ranks = 1; ranks; ranks = next_count(p, ranks)) {
        const ec_plan_row row = ec_plan_for(p, ranks);
        cJSON *one = cJSON_CreateObject();
        ec_json_whole(one, "ranks", ranks);
        ec_json_real(one, "seconds", row.seconds);
        ec_json_real(one, "efficiency", row.efficiency);
        ec_json_real(one, "load_seconds", row.load);
        ec_json_real(one, "send_seconds", row.send);
        ec_json_real(one, "render_seconds", row.render);
        ec_json_real(one, "wait_seconds", row.wait);
        ec_json_real(one, "received_bytes", row.received);
        ec_json_text(one, "held_back_by", row.held_by);
        cJSON_AddItemToArray(rows, one);
    }
    return ec_json_print(root, to, err);
}
