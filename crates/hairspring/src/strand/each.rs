//! Loops over constants that must be unrolled, so that the arrays they index stay in registers.

/// Repeats `body` for each of the indices. Without a list, the indices are 0 to 11, the widest window of a
/// band. The compiler does not unroll nested loops of this size.
macro_rules! each {
    ($i:ident, $body:block) => {
        each!($i of 0 1 2 3 4 5 6 7 8 9 10 11, $body)
    };
    ($i:ident of $($k:literal)*, $body:block) => {
        $({
            let $i: usize = $k;
            $body
        })*
    };
}
