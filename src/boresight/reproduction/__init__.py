"""The paper's section 4, done again: its tables, figures and statements beside what is measured."""

