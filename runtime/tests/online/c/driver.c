/* Reads commands from the standard input and writes results, numbers as hexadecimal floating point. */
#include "overact_online.h"

#include <stdio.h>
#include <string.h>

static overact_online_number next(void)
{
    double x = 0.0;
    if (scanf("%la", &x) != 1) {
        puts("no number");
    }
    return (overact_online_number)x;
}

static void print(const char *name, int error, const overact_online_number *numbers, int count)
{
    printf("%s %d", name, error);
    for (int i = 0; (i < count) && (error == 0); i++) {
        printf(" %a", (double)numbers[i]);
    }
    printf("\n");
}

int main(void)
{
    static overact_online_number memory[OVERACT_ONLINE_MEMORY(20)];
    static overact_online_number out[400];
    overact_online_filter filter;
    overact_online_change_test test;
    overact_online_whitening whitening;
    overact_online_state_variable_filter signal;
    int columns[10];
    overact_online_number mass = 1;
    overact_online_number length = 1;
    char word[32];
    while (scanf("%31s", word) == 1) {
        if (strcmp(word, "init") == 0) {
            print(word, (int)overact_online_init(&filter, (int)next(), memory), out, 0);
        } else if (strcmp(word, "prior") == 0) {
            overact_online_number root[400];
            for (int i = 0; i < filter.parameters; i++) {
                out[i] = next();
            }
            for (int i = 0; i < (filter.parameters * filter.parameters); i++) {
                root[i] = next();
            }
            print(word, (int)overact_online_set_prior(&filter, out, root), out, 0);
        } else if (strcmp(word, "forget") == 0) {
            const overact_online_rule rule = (overact_online_rule)(int)next();
            print(word, (int)overact_online_set_forgetting(&filter, rule, next()), out, 0);
        } else if (strcmp(word, "block") == 0) {
            overact_online_number rows[60];
            overact_online_number y[3];
            overact_online_number sigma[3];
            overact_online_innovation innovations[3];
            const int count = (int)next();
            int error;
            for (int i = 0; i < count; i++) {
                for (int j = 0; j < filter.parameters; j++) {
                    rows[i * filter.parameters + j] = next();
                }
                y[i] = next();
                sigma[i] = next();
            }
            error = (int)overact_online_update_block(&filter, count, rows, y, sigma, innovations);
            for (int i = 0; i < count; i++) {
                out[3 * i] = innovations[i].residual;
                out[3 * i + 1] = innovations[i].standard_deviation;
                out[3 * i + 2] = innovations[i].normalised;
            }
            print(word, error, out, 3 * count);
        } else if (strcmp(word, "discount") == 0) {
            print(word, (int)overact_online_discount(&filter, next()), out, 0);
        } else if (strcmp(word, "estimate") == 0) {
            print(word, (int)overact_online_estimate(&filter, out), out, filter.parameters);
        } else if (strcmp(word, "deviations") == 0) {
            print(word, (int)overact_online_standard_deviations(&filter, out), out, filter.parameters);
        } else if (strcmp(word, "covariance") == 0) {
            const int count = filter.parameters * filter.parameters;
            print(word, (int)overact_online_covariance(&filter, out), out, count);
        } else if (strcmp(word, "test") == 0) {
            const overact_online_number shift = next();
            const int error = (int)overact_online_change_init(&test, shift, next());
            overact_online_whitening_init(&whitening);
            print(word, error, &test.threshold, 1);
        } else if (strcmp(word, "innovation") == 0) {
            out[0] = overact_online_whitening_update(&whitening, next());
            out[1] = (overact_online_number)overact_online_change_update(&test, out[0]);
            print(word, 0, out, 2);
        } else if (strcmp(word, "signal") == 0) {
            const int order = (int)next();
            const overact_online_number cutoff = next();
            print(word, (int)overact_online_signal_init(&signal, order, cutoff, next()), &signal.delay, 1);
        } else if (strcmp(word, "sample") == 0) {
            print(word, (int)overact_online_signal_update(&signal, next(), out), out, 3);
        } else if (strcmp(word, "payload") == 0) {
            const int count = (int)next();
            for (int i = 0; i < count; i++) {
                columns[i] = (int)next();
            }
            mass = next();
            length = next();
            print(word, (int)overact_online_payload_init(&filter, count, columns, mass, length, memory), out, 0);
        } else if (strcmp(word, "body") == 0) {
            overact_online_payload payload;
            const int error = (int)overact_online_payload_estimate(&filter, columns, mass, length, &payload);
            for (int i = 0; (i < 10) && (error == 0); i++) {
                out[i] = payload.parameters[i];
            }
            for (int i = 0; (i < 9) && (error == 0); i++) {
                out[10 + i] = payload.inertia[i / 3][i % 3];
            }
            out[19] = (error == 0) ? (overact_online_number)payload.is_projected : 0;
            print(word, error, out, 20);
        } else {
            printf("unknown %s\n", word);
            return 1;
        }
    }
    return 0;
}
