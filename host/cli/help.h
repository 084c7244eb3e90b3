/* Help texts, one literal a command. */
#ifndef EC_CLI_HELP_H
#define EC_CLI_HELP_H

extern const char EC_HELP_SHORT[];

#endif
