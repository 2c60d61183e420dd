/* Calls a model for successive states; prints the shortest and the median time per call in nanoseconds. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

void model(const double **inputs, double *output);

static const int lengths[] = {@LENGTHS@};

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static int order(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int count, char **arguments) {
    static double output[@OUTPUTS@];
    int total = 0;
    for (int i = 0; i < @INPUTS@; ++i) total += lengths[i];
    FILE *file = count > 2 ? fopen(arguments[1], "rb") : NULL;
    if (!file) return 2;
    fseek(file, 0, SEEK_END);
    long states = ftell(file) / (long)(sizeof(double) * (size_t)total);
    rewind(file);
    double *values = malloc(sizeof(double) * (size_t)(states * total));
    if (fread(values, sizeof(double), (size_t)(states * total), file) != (size_t)(states * total)) return 2;
    fclose(file);
    int batches = atoi(arguments[2]);
    double *times = malloc(sizeof(double) * (size_t)batches);
    for (int batch = 0; batch < batches; ++batch) {
        double start = now();
        for (long k = 0; k < states; ++k) {
            const double *inputs[@INPUTS@];
            const double *at = values + k * total;
            for (int i = 0; i < @INPUTS@; at += lengths[i], ++i) inputs[i] = at;
            model(inputs, output);
            __asm__ volatile("" : : "r"(output) : "memory");
        }
        times[batch] = (now() - start) / (double)states;
    }
    qsort(times, (size_t)batches, sizeof(double), order);
    if (count > 3) {
        FILE *dump = fopen(arguments[3], "wb");
        for (long k = 0; k < states; ++k) {
            const double *inputs[@INPUTS@];
            const double *at = values + k * total;
            for (int i = 0; i < @INPUTS@; at += lengths[i], ++i) inputs[i] = at;
            model(inputs, output);
            fwrite(output, sizeof(double), @OUTPUTS@, dump);
        }
        fclose(dump);
    }
    printf("%.3f %.3f\n", times[0], times[batches / 2]);
    return 0;
}
