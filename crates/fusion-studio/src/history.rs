//! The document's past and future: undo is a list of documents.

use fusion::Document;
use std::sync::Arc;

/// States of the document, of which one is the present.
#[derive(Debug)]
pub struct History {
    states: Vec<State>,
    present: usize,
}

#[derive(Debug)]
struct State {
    document: Arc<Document>,
    /// The drag that led to it.
    drag: Option<u64>,
}

/// The most states that are kept.
const MOST: usize = 1000;

impl History {
    /// A past without events.
    pub fn new(document: Document) -> Self {
        Self { states: vec![State { document: Arc::new(document), drag: None }], present: 0 }
    }

    /// The document as it is.
    pub fn document(&self) -> &Arc<Document> {
        // There is always a present one.
        &self.states[self.present].document
    }

    /// Adds a state behind the present one, in the place of what was undone. One of the same drag takes the place of the present one.
    pub fn push(&mut self, document: Document, drag: Option<u64>) {
        self.states.truncate(self.present + 1);
        let same_drag = drag.is_some() && self.states[self.present].drag == drag;
        // The state from which the drag began stays.
        if same_drag && self.present > 0 {
            self.states.pop();
        }
        self.states.push(State { document: Arc::new(document), drag });
        if self.states.len() > MOST {
            self.states.remove(0);
        }
        self.present = self.states.len() - 1;
    }

    /// Whether there is a past.
    pub fn can_undo(&self) -> bool {
        self.present > 0
    }

    /// Whether there is a future.
    pub fn can_redo(&self) -> bool {
        self.present + 1 < self.states.len()
    }

    /// Goes back by one state, where there is one.
    pub fn undo(&mut self) -> bool {
        let can = self.can_undo();
        self.present -= usize::from(can);
        can
    }

    /// Goes forward by one state, where there is one.
    pub fn redo(&mut self) -> bool {
        let can = self.can_redo();
        self.present += usize::from(can);
        can
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(n: usize) -> Document {
        Document::parse(&format!("version = 2\n[parameters]\nn = {n}\n")).unwrap()
    }

    fn now(history: &History) -> i64 {
        history.document().parameters()["n"].as_integer().unwrap()
    }

    #[test]
    fn a_drag_is_one_point_of_undo() {
        let mut history = History::new(document(0));
        history.push(document(1), None);
        for n in 2..6 {
            history.push(document(n), Some(7));
        }
        history.push(document(6), Some(8));
        assert!(history.undo());
        assert_eq!(now(&history), 5);
        assert!(history.undo());
        assert_eq!(now(&history), 1);
        assert!(history.redo() && history.redo() && !history.redo());
        assert_eq!(now(&history), 6);
        history.undo();
        history.push(document(9), None);
        assert!(!history.can_redo());
        assert!(history.undo() && history.undo() && history.undo() && !history.undo());
        assert_eq!(now(&history), 0);
    }

    #[test]
    fn the_past_is_bounded() {
        let mut history = History::new(document(0));
        for n in 1..2 * MOST {
            history.push(document(n), None);
        }
        assert_eq!(now(&history) as usize, 2 * MOST - 1);
        while history.undo() {}
        assert_eq!(now(&history) as usize, MOST);
    }
}
