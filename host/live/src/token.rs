//! The secret in the page's address: whoever has it may watch, and move what the rig moves.

use std::fmt;
use subtle::ConstantTimeEq;

/// 128 random bits.
#[derive(Clone)]
pub struct Token(String);

/// The system has no random bits to give.
#[derive(Debug, thiserror::Error)]
#[error("no random bits for the page's secret: {0}")]
pub struct TokenError(getrandom::Error);

impl Token {
    /// A fresh one for every start.
    ///
    /// # Errors
    /// The system has no random bits.
    pub fn fresh() -> Result<Self, TokenError> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(TokenError)?;
        Ok(Self(format!("{:032x}", u128::from_be_bytes(bytes))))
    }

    /// Whether somebody knows it. How long that takes says nothing of how much of it was right.
    pub(crate) fn is(&self, told: &str) -> bool {
        self.0.as_bytes().ct_eq(told.as_bytes()).into()
    }
}

/// As it stands in the address.
impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_known_by_itself_alone() {
        let (token, other) = (Token::fresh().expect("random bits"), Token::fresh().expect("random bits"));
        let said = token.to_string();
        assert_eq!(said.len(), 32);
        assert!(token.is(&said));
        assert!(!token.is(&other.to_string()) && !token.is("") && !token.is(&said[..31]));
        assert!(!token.is(&format!("{said}0")));
    }
}
