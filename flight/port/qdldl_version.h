/* Stands for what QDLDL's own build writes; nothing asks for the version. */
