/* A value with the sign of a velocity: a product, as a selection would be a branch that is often guessed wrong. */
static double rob_signed(double value, double velocity)
{
    return value * rob_sign(velocity);
}
