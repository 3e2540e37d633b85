//! Numbers of workers to measure.

/// 1, 2, 4 and so on, and `most`.
pub fn doubling(most: usize) -> Vec<usize> {
    let mut numbers: Vec<_> = (0..).map(|k| 1 << k).take_while(|&n| n < most).collect();
    numbers.push(most);
    numbers
}

/// So many workers, in words.
pub fn counted(workers: usize) -> String {
    let plural = if workers == 1 { "" } else { "s" };
    format!("{workers} worker{plural}")
}

#[cfg(test)]
mod tests {
    use super::doubling;

    #[test]
    fn numbers_double_up_to_all() {
        assert_eq!(doubling(1), [1]);
        assert_eq!(doubling(8), [1, 2, 4, 8]);
        assert_eq!(doubling(12), [1, 2, 4, 8, 12]);
    }
}
